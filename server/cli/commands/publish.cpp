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
#include "server/cli/support/described_files.h"
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

tl::expected<InputFile, Fault> open_input(const DescribedFile& described) {
  auto file = InputFile::open(described.model.file);
  if (!file) return failed(file.error());
  if (file->is_pmesh() && described.states_reading)
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

nlohmann::json order_of(const DescribedFile& described) {
  const auto& [about, reading] = std::tie(described.about, described.reading);
  nlohmann::json order = {{"publish", true}, {"up", reading.up == UpAxis::kZ ? "z" : "y"}};
  order["metadata"] = about.more;
  order["metadata"].update({{"title", about.title},
                            {"creator", about.creator},
                            {"rights", about.rights},
                            {"licence", about.licence}});
  if (!reading.unit.empty()) order["unit"] = reading.unit;
  return order;
}

// A published model. `url` is empty if the model was published with --data instead of --server.
struct PublishedFile {
  std::string id, url;
};

tl::expected<PublishedFile, Fault> publish_at_server(RemoteVitrine& remote,
                                                     const DescribedFile& described) {
  const auto file = open_input(described);
  if (!file) return tl::unexpected(file.error());
  const std::string& path = described.model.file;
  const auto sent = file_to_send(*file, described.model, described.reading);
  if (!sent) return tl::unexpected(sent.error());
  const auto done = publish_upload(remote, *sent, order_of(described));
  if (!done) return failed(fmt::format("{}: {}", path, done.error().message));
  if (sent->repairs.empty()) print_repairs(path, done->value("repairs", Lines()));
  const std::string id = done->value("model", "");
  return PublishedFile{id, remote.origin() + "/models/" + id};
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

// Returns the .pmesh file to publish. Called before the installation is opened, so that a long
// build does not lock the installation.
tl::expected<BuiltFile, Fault> built_for(const InstallationPlace& place,
                                         const StorageLimits& limits,
                                         const DescribedFile& described) {
  const auto file = open_input(described);
  if (!file) return tl::unexpected(file.error());
  const CompanionFiles companions(described.model, file->bytes());
  ReadOptions reading = described.reading;
  reading.beside = companions.contents();
  reading.name = described.model.file;
  return make_pmesh(
      *file, described.model.file, reading,
      {.folder = place.folder, .disk_reserve = limits.disk.reserve, .input = file->bytes()});
}

tl::expected<PublishedFile, Fault> publish_in(const InstallationPlace& place,
                                              const StorageLimits& limits,
                                              const DescribedFile& described) {
  const auto pmesh = built_for(place, limits, described);
  if (!pmesh) return tl::unexpected(pmesh.error());
  const auto installation = open_installation(place);
  if (!installation) return failed(installation.error());
  const auto trail = AuditTrail::open(installation->place.folder);
  if (!trail) return failed(trail.error());
  const std::string& path = described.model.file;
  const auto published = publish_within(limits, *installation, *pmesh, described.about);
  trail->record("publish", published ? published->id.to_string() : path, published.has_value());
  if (!published) return failed(published.error());
  const std::string id = published->id.to_string();
  if (!published->is_new) {
    print_note(fmt::format(
        "{} is published under this title already, as {}; give another title to publish it again",
        path, id));
  }
  return PublishedFile{id, ""};
}

CommandOutcome show(const PublishedFile& published, const DescribedFile& described,
                    const Arguments& arguments, bool is_one_of_many) {
  const auto& [id, url] = published;
  if (!arguments.has("--json")) return print(url.empty() ? id : url);
  nlohmann::json object = {{"id", id}, {"url", nullptr}};
  if (!url.empty()) object["url"] = url;
  if (is_one_of_many) object["file"] = described.model.file;
  return print_json(object);
}

// Publishes one file after the other. If one fails, continues with the next.
template <class Publish>
CommandOutcome publish_all(const Arguments& arguments, const std::vector<DescribedFile>& files,
                           const Publish& publish) {
  std::size_t failures = 0;
  for (const DescribedFile& described : files) {
    const auto published = publish(described);
    if (!published && files.size() == 1) return tl::unexpected(published.error());
    if (!published) {
      print_fault(published.error().message);
      ++failures;
    } else if (auto shown = show(*published, described, arguments, files.size() > 1); !shown) {
      return shown;
    }
  }
  if (failures == 0) return {};
  return failed(fmt::format(
      "{} of {} files are not published; mend them and run the command again, which publishes no "
      "file twice",
      failures, files.size()));
}

CommandOutcome publish_files_at_server(const Arguments& arguments) {
  if (arguments.has("--data")) return misused("--data and --server exclude each other; give one");
  auto remote = RemoteVitrine::of(arguments);
  if (!remote) return tl::unexpected(remote.error());
  const auto files = described_files(arguments);
  if (!files) return tl::unexpected(files.error());
  return publish_all(arguments, *files,
                     [&](const DescribedFile& file) { return publish_at_server(*remote, file); });
}

CommandOutcome publish_files(const Arguments& arguments) {
  if (arguments.has("--server")) return publish_files_at_server(arguments);
  if (names_token(arguments)) return misused("a token needs --server; leave it out");
  if (!arguments.has("--data"))
    return misused("--data or --server is missing; name the data folder or the server");
  const auto files = described_files(arguments);
  if (!files) return tl::unexpected(files.error());
  const auto place = place_of(arguments.text("--data"));
  if (!place) return failed(place.error());
  if (const auto usable = check_existing(*place); !usable) return failed(usable.error());
  const auto limits = storage_limits_of(arguments.text("--data"));
  if (!limits) return failed(limits.error());
  return publish_all(arguments, *files,
                     [&](const DescribedFile& file) { return publish_in(*place, *limits, file); });
}

constexpr std::string_view kPublishOperands[] = {"IN..."};
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
    kSheetFlag,
    {"--json", "", "print one JSON object for each model: id, url, and file if there are several"}};

}  // namespace

const Command kPublish = {
    .name = "publish",
    .summary =
        "Publishes meshes, packages of a mesh and its pictures (zip, tar or gzip) or .pmesh files.",
    .details =
        "IN may be a folder with one model and its pictures. Give --data on the daemon's machine, "
        "or --server and --token anywhere else. If the same model is published already with the "
        "same texts, prints its ID and does not publish it again. If one of several files fails, "
        "continues with the next, and ends with exit code 1.",
    .operands = kPublishOperands,
    .flags = kPublishFlags,
    .examples =
        "vitrine publish bust.ply --data /var/lib/vitrine --title Bust\nvitrine publish bust.glb "
        "--server https://museum.example --token-file token.txt --licence CC0-1.0\nvitrine publish "
        "*.glb --metadata sheet.csv --server https://museum.example --token-file token.txt",
    .run = publish_files};

}  // namespace vitrine::server::cli
