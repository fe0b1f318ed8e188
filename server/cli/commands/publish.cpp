// SPDX-License-Identifier: Apache-2.0
#include "server/store/publish.h"

#include <fmt/core.h>

#include <filesystem>

#include "codec/build/build_model.h"
#include "codec/build/verify_model.h"
#include "codec/files/companions.h"
#include "server/cli/client/remote_vitrine.h"
#include "server/cli/commands/command.h"
#include "server/cli/support/access_token.h"
#include "server/cli/support/audit_trail.h"
#include "server/cli/support/companion_files.h"
#include "server/cli/support/console.h"
#include "server/cli/support/input.h"
#include "server/cli/support/isolation.h"
#include "server/cli/support/place.h"
#include "server/cli/support/reading.h"
#include "server/metadata/text.h"

namespace vitrine::server::cli {
namespace {

using Bytes = std::vector<std::uint8_t>;

using Lines = std::vector<std::string>;

// A .pmesh file, and a list of what its build changed or left out. The list is empty for a file
// that was built earlier, because nothing is known of its build.
struct BuiltFile {
  Bytes bytes;
  Lines repairs = {};
};

void print_repairs(const std::string& path, const Lines& repairs) {
  for (const std::string& repair : repairs)
    print_note(fmt::format("{}: {}", path, repair));
}

// Returns the .pmesh file to publish. Builds it if the input is a mesh, and prints the repairs. If
// the input is a .pmesh, first decodes all of it as a check, because the file may be damaged or
// hostile.
tl::expected<BuiltFile, Fault> make_pmesh(const InputFile& file, const std::string& path,
                                          const ReadOptions& reading, const SpillOptions& spill) {
  const auto task = [&](const ProgressReport& progress) -> Expected<Product> {
    if (file.is_pmesh()) {
      const auto verified = verify_model(file.bytes(), std::nullopt, progress);
      if (!verified) return tl::unexpected(verified.error());
      return Product{nlohmann::json::object(), Bytes(file.bytes().begin(), file.bytes().end())};
    }
    auto built = build_model(file.bytes(), {.reading = reading}, progress);
    if (!built) return tl::unexpected(built.error());
    nlohmann::json report = {{"repairs", built->report.input.repairs}};
    if (auto note = note_on_unit(file.bytes(), reading); !note.empty()) report["note"] = note;
    return Product{std::move(report), std::move(built->file)};
  };
  const auto product = isolate(path, task, spill);
  if (!product) return tl::unexpected(product.error());
  BuiltFile built{product->file, product->report.value("repairs", Lines())};
  print_repairs(path, built.repairs);
  return built;
}

tl::expected<InputFile, Fault> open_input(const Arguments& arguments, const std::string& path) {
  auto file = InputFile::open(path);
  if (!file) return failed(file.error());
  if (file->is_pmesh() && (arguments.has("--unit") || arguments.has("--up")))
    return misused("--unit and --up apply to meshes; a .pmesh file has both, so build it again");
  return std::move(*file);
}

// Returns the file to upload. If a mesh refers to files beside it, builds the .pmesh file on this
// machine, because the server cannot open those files.
tl::expected<BuiltFile, Fault> file_to_send(const InputFile& file, const ModelPath& path,
                                            ReadOptions reading) {
  const CompanionFiles companions(path, file.bytes());
  reading.beside = companions.contents();
  if (!file.is_pmesh() && !reading.beside.empty()) return make_pmesh(file, path.file, reading, {});
  return BuiltFile{Bytes(file.bytes().begin(), file.bytes().end())};
}

// Uploads the file and publishes the model. Returns the finished job.
tl::expected<nlohmann::json, Fault> publish_upload(RemoteVitrine& remote, const BuiltFile& file,
                                                   nlohmann::json order) {
  ProgressBar bar;
  const auto upload = remote.upload(file.bytes, bar.report());
  if (!upload) return tl::unexpected(upload.error());
  order["upload"] = *upload;
  if (!file.repairs.empty()) order["repairs"] = lines_of(joined_lines(file.repairs));
  const auto started =
      remote.ask_with_retries("POST", "/api/v1/models", order, "Idempotency-Key: " + *upload);
  if (!started) return tl::unexpected(started.error());
  return remote.await(started->value("job", ""), bar.report());
}

ModelMetadata metadata_of(const Arguments& arguments, std::filesystem::path name) {
  if (name.extension() == ".gz") name.replace_extension();
  return {.title = arguments.text("--title", as_utf8(name.stem().string())),
          .creator = arguments.text("--creator"),
          .rights = arguments.text("--rights"),
          .licence = arguments.text("--licence")};
}

nlohmann::json order_of(const ModelMetadata& about, const ReadOptions& reading) {
  nlohmann::json order = {{"publish", true}, {"up", reading.up == UpAxis::kZ ? "z" : "y"}};
  order["metadata"] = {{"title", about.title},
                       {"creator", about.creator},
                       {"rights", about.rights},
                       {"licence", about.licence}};
  if (!reading.unit.empty()) order["unit"] = reading.unit;
  return order;
}

CommandOutcome publish_at_server(const Arguments& arguments) {
  if (arguments.has("--data")) return misused("--data and --server exclude each other; give one");
  auto remote = RemoteVitrine::of(arguments);
  if (!remote) return tl::unexpected(remote.error());
  const auto reading = reading_options(arguments);
  if (!reading) return tl::unexpected(reading.error());
  const auto model = ModelPath::of(arguments.operand(0));
  if (!model) return failed(model.error());
  const std::string& path = model->file;
  const ModelMetadata about = metadata_of(arguments, path);
  if (const auto usable = check_texts(about); !usable) return failed(usable.error());
  const auto file = open_input(arguments, path);
  if (!file) return tl::unexpected(file.error());
  const auto sent = file_to_send(*file, *model, *reading);
  if (!sent) return tl::unexpected(sent.error());
  const auto done = publish_upload(*remote, *sent, order_of(about, *reading));
  if (!done) return failed(fmt::format("{}: {}", path, done.error().message));
  if (sent->repairs.empty()) print_repairs(path, done->value("repairs", Lines()));
  const std::string id = done->value("model", ""), url = remote->origin() + "/models/" + id;
  return arguments.has("--json") ? print_json({{"id", id}, {"url", url}}) : print(url);
}

// Publishes the file if the installation's limits on disk space allow it.
Expected<Publication> publish_within(const StorageLimits& limits, const Installation& installation,
                                     const BuiltFile& file, const ModelMetadata& metadata) {
  const auto stored = installation.store->size_of(sha256(file.bytes));
  if (!stored) return tl::unexpected(stored.error());
  const std::uint64_t more = *stored ? 0 : file.bytes.size();
  if (auto fits = check_reserve(installation.place, more, limits.disk.reserve); !fits)
    return tl::unexpected(fits.error());
  const Uploads uploads(limits.uploads, {});
  Quota quota(*installation.catalogue, uploads, limits.disk.quota);
  return publish(*installation.store, *installation.catalogue, file.bytes, metadata,
                 {.quota = &quota, .repairs = joined_lines(file.repairs)});
}

CommandOutcome publish_file(const Arguments& arguments) {
  if (arguments.has("--server")) return publish_at_server(arguments);
  if (names_token(arguments)) return misused("a token needs --server; leave it out");
  if (!arguments.has("--data"))
    return misused("--data or --server is missing; name the data folder or the server");
  auto reading = reading_options(arguments);
  if (!reading) return tl::unexpected(reading.error());
  const auto model = ModelPath::of(arguments.operand(0));
  if (!model) return failed(model.error());
  const std::string& path = model->file;
  const auto file = open_input(arguments, path);
  if (!file) return tl::unexpected(file.error());
  const auto place = place_of(arguments.text("--data"));
  if (!place) return failed(place.error());
  if (const auto usable = check_existing(*place); !usable) return failed(usable.error());
  const CompanionFiles companions(*model, file->bytes());
  reading->beside = companions.contents();
  reading->name = path;
  const auto limits = storage_limits_of(arguments.text("--data"));
  if (!limits) return failed(limits.error());
  const SpillOptions spill{
      .folder = place->folder, .disk_reserve = limits->disk.reserve, .input = file->bytes()};
  const auto pmesh = make_pmesh(*file, path, *reading, spill);
  if (!pmesh) return tl::unexpected(pmesh.error());

  const auto installation = open_installation(*place);
  if (!installation) return failed(installation.error());
  const auto trail = AuditTrail::open(installation->place.folder);
  if (!trail) return failed(trail.error());
  const auto published =
      publish_within(*limits, *installation, *pmesh, metadata_of(arguments, path));
  trail->record("publish", published ? published->id.to_string() : path, published.has_value());
  if (!published) return failed(published.error());
  const std::string id = published->id.to_string();
  if (!published->is_new) {
    print_note(fmt::format(
        "{} is published under this title already, as {}; give another --title to publish it again",
        path, id));
  }
  if (!arguments.has("--json")) return print(id);
  return print_json({{"id", id}, {"url", nullptr}});
}

constexpr std::string_view kPublishOperands[] = {"IN"};
constexpr Flag kPublishFlags[] = {
    {"--data", "DIR|FILE",
     "data folder on this machine, or configuration file of its daemon, which may be running"},
    kUnitFlag,
    kUpFlag,
    {"--server", "URL", "address of a server, such as https://museum.example, instead of --data"},
    {"--token", "T", "with --server: access token of role operator or higher"},
    kTokenFileFlag,
    {"--title", "T", "title of the model (default: name of the file)"},
    {"--creator", "C", "maker of the object"},
    {"--rights", "R", "holder of the rights, such as \"Museum of Example, 2026\""},
    {"--licence", "L", "licence, such as CC-BY-4.0 or its address"},
    {"--json", "", "print the result as one JSON object: id and url"}};

}  // namespace

const Command kPublish = {
    .name = "publish",
    .summary =
        "Publishes a mesh, a package of a mesh and its pictures (zip, tar or gzip) or a .pmesh "
        "file.",
    .details =
        "IN may be a folder with one model and its pictures. Give --data on the daemon's machine, "
        "or --server and --token anywhere else. If the same model is published already with the "
        "same title, creator, rights and licence, prints its ID and publishes nothing.",
    .operands = kPublishOperands,
    .flags = kPublishFlags,
    .examples =
        "vitrine publish bust.ply --data /var/lib/vitrine --title Bust\nvitrine publish bust.glb "
        "--server https://museum.example --token-file token.txt --licence CC0-1.0",
    .run = publish_file};

}  // namespace vitrine::server::cli
