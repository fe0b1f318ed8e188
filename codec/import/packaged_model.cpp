// SPDX-License-Identifier: Apache-2.0
#include "codec/import/packaged_model.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <optional>
#include <utility>

#include "codec/gltf/glb_file.h"
#include "codec/gltf/gltf_document.h"
#include "codec/gltf/gltf_resources.h"
#include "codec/import/formats.h"
#include "codec/import/other_files.h"
#include "codec/import/text_cursor.h"

namespace vitrine::inline codec {
namespace {

consteval bool ranks_differ() {
  for (const ImportFormat& format : kImportFormats)
    for (const ImportFormat& other : kImportFormats)
      if (&format != &other && format.package_rank == other.package_rank) return false;
  return true;
}
static_assert(ranks_differ(), "two formats of codec/import/formats.h have the same package_rank");

// Returns the path of a model as the user knows it. A 3MF file is a package; unpack() returns its
// part 3D/3dmodel.model, which lists the objects. For such a part, returns the path of the 3MF
// file. For all other files, returns `path`.
std::string visible_path(std::string_view path) {
  constexpr std::string_view kPart = "3d/3dmodel.model", kAlone = "model.3mf";
  if (!lower_case(path).ends_with(kPart)) return std::string(path);
  path.remove_suffix(kPart.size());
  return path.empty() ? std::string(kAlone) : std::string(path.substr(0, path.size() - 1));
}

// Whether the file is hidden, or is one of the metadata files that macOS adds to packages.
bool is_hidden(std::string_view path) {
  const std::size_t slash = path.rfind('/');
  return path.substr(slash == path.npos ? 0 : slash + 1).starts_with('.') ||
         path.find("__MACOSX/") != path.npos;
}

// Returns the format of the name's extension, or null if no mesh file has that extension.
const ImportFormat* format_by_name(std::string_view key) {
  const std::size_t dot = key.rfind('.');
  const auto* found = std::ranges::find(kImportFormats, dot == key.npos ? "" : key.substr(dot + 1),
                                        &ImportFormat::extension);
  return found == std::end(kImportFormats) ? nullptr : found;
}

bool is_package_name(std::string_view key) {
  constexpr std::array<std::string_view, 5> kPackages{".zip", ".tar", ".gz", ".tgz", ".3mf"};
  return std::ranges::any_of(kPackages,
                             [&](std::string_view extension) { return key.ends_with(extension); });
}

bool is_wanted(std::string_view path) {
  if (is_hidden(path)) return false;
  const std::string key = name_key(path);
  return format_by_name(key) || is_package_name(key) || key.ends_with(".model") ||
         companion_kind(key) != CompanionKind::kOther;
}

// The part of a file name that states a level of detail, such as "_lod2".
struct LodMark {
  std::size_t begin, size;
  unsigned number;
};

// Returns the last level-of-detail mark in `text`, which must be in lower case. Returns nullopt if
// there is none.
std::optional<LodMark> lod_mark(std::string_view text) {
  constexpr std::string_view kWord = "lod", kSeparators = "_-. ";
  const std::size_t word = text.rfind(kWord);
  if (word == text.npos) return std::nullopt;
  std::size_t digits = word + kWord.size();
  if (digits < text.size() && kSeparators.find(text[digits]) != kSeparators.npos) ++digits;
  unsigned number = 0;
  const auto parsed = std::from_chars(text.data() + digits, text.data() + text.size(), number);
  if (parsed.ec != std::errc()) return std::nullopt;
  const bool is_separated = word > 0 && kSeparators.find(text[word - 1]) != kSeparators.npos;
  const std::size_t begin = word - (is_separated ? 1 : 0);
  return LodMark{begin, static_cast<std::size_t>(parsed.ptr - text.data()) - begin, number};
}

// A file that may be the model.
struct Candidate {
  std::size_t file;            // index in the files of the package or folder
  std::string model;           // name without folders, extension and level-of-detail mark
  unsigned level;              // level of detail; 0 is the most detailed
  const ImportFormat* format;  // a row of kImportFormats

  auto order() const { return std::pair(level, format->package_rank); }
  // Whether this is a file of a modelling program.
  bool is_scene() const { return format->is_scene; }
};

Candidate candidate(std::size_t file, const std::string& path, const ImportFormat& format) {
  std::string name = name_key(path);
  name.resize(name.size() - format.extension.size() - 1);
  if (const auto mark = lod_mark(name)) name.erase(mark->begin, mark->size);
  const auto level = lod_mark(lower_case(path));
  return {file, name, level ? level->number : 0, &format};
}

std::vector<Candidate> candidates_in(std::span<const std::string> paths) {
  std::vector<Candidate> candidates;
  for (std::size_t i = 0; i < paths.size(); ++i) {
    const std::string path = visible_path(paths[i]);
    const ImportFormat* format = format_by_name(name_key(path));
    if (format && !is_hidden(path)) candidates.push_back(candidate(i, path, *format));
  }
  std::ranges::stable_sort(candidates, {}, &Candidate::order);
  return candidates;
}

// Removes the files of modelling programs if there are other candidates.
void drop_scenes(std::vector<Candidate>& candidates) {
  if (!std::ranges::all_of(candidates, &Candidate::is_scene))
    std::erase_if(candidates, [](const Candidate& other) { return other.is_scene(); });
}

// Whether all candidates are files of the same model, and the first candidate is better than the
// second. Candidates must be sorted by order().
bool are_one_model(const std::vector<Candidate>& candidates) {
  return std::ranges::all_of(
             candidates,
             [&](const Candidate& other) { return other.model == candidates[0].model; }) &&
         (candidates.size() == 1 || candidates[0].order() < candidates[1].order());
}

Unexpected too_many(std::span<const std::string> paths, const std::vector<Candidate>& candidates,
                    const std::string& holder) {
  constexpr std::size_t kNamed = 4;
  std::string names;
  for (std::size_t i = 0; i < std::min(candidates.size(), kNamed); ++i)
    names += (i > 0 ? ", " : "") + in_quotes(paths[candidates[i].file]);
  if (candidates.size() > kNamed) names += ", ...";
  return bad_input("the " + holder + " has " + counted(candidates.size(), "model") + ", " + names +
                   "; give one " + holder + " or file for each of them");
}

std::vector<std::string> paths_of(const std::vector<PackedFile>& files) {
  std::vector<std::string> paths;
  for (const PackedFile& file : files)
    paths.emplace_back(file.path);
  return paths;
}

// Returns the only file that is the model part of a 3MF package, whatever its name: some programs
// do not call it 3D/3dmodel.model. Returns nullopt if there is none or several.
std::optional<std::size_t> only_3mf_part(const std::vector<PackedFile>& files) {
  const auto is_part = [](const PackedFile& file) { return is_3mf(file.bytes); };
  const auto found = std::ranges::find_if(files, is_part);
  if (found == files.end() || std::find_if(found + 1, files.end(), is_part) != files.end())
    return std::nullopt;
  return static_cast<std::size_t>(found - files.begin());
}

// Returns the error for a package without a model. If the package itself is of a known, unsupported
// kind, the error names that kind. Otherwise, the error names the first file that is a model in an
// unsupported format. If there is no such file, the error states the number of files.
Unexpected no_model(std::span<const std::uint8_t> package, const std::vector<PackedFile>& files) {
  if (const auto kind = describe_other_file(package)) return bad_input(kind->text);
  for (const PackedFile& file : files) {
    const auto kind =
        is_hidden(file.path) ? std::nullopt : describe_other_file(file.bytes, file.path);
    if (kind && kind->is_model)
      return bad_input(in_quotes(file.path) + " in the package: " + kind->text);
  }
  return bad_input("the package has no model among its " + counted(files.size(), "file") +
                   "; pack one as " + std::string(kImportFormatNames));
}

// Returns the folders of a path, such as {"a/", "a/b/"} for "a/b/c".
std::vector<std::string_view> folders_of(std::string_view path) {
  std::vector<std::string_view> folders;
  for (std::size_t at = path.find('/'); at != path.npos; at = path.find('/', at + 1))
    folders.push_back(path.substr(0, at + 1));
  return folders;
}

// Returns the path `to`, relative to the folder of the path `from`.
std::string relative_path(std::string_view from, std::string_view to) {
  const auto ups = folders_of(from), downs = folders_of(to);
  const auto fork = std::ranges::mismatch(ups, downs).in1;
  std::string path;
  for (auto up = fork; up != ups.end(); ++up)
    path += "../";
  return path += to.substr(fork == ups.begin() ? 0 : std::prev(fork)->size());
}

// Returns the JSON of a glTF file, or an empty text for other files.
std::string_view json_of_gltf(std::span<const std::uint8_t> model) {
  if (is_gltf(model)) return {reinterpret_cast<const char*>(model.data()), model.size()};
  const auto chunks = is_glb(model) ? split_glb(model) : Expected<GlbChunks>();
  return chunks ? chunks->json : std::string_view();
}

// Returns the name_key() of each file that a glTF model states. Returns an empty set for models of
// other formats, and for a damaged glTF.
std::set<std::string> files_of_gltf(std::span<const std::uint8_t> model) {
  const std::string_view json = json_of_gltf(model);
  if (json.empty()) return {};
  const auto document = parse_gltf(json, {});
  return document ? names_of_files(*document) : std::set<std::string>();
}

}  // namespace

Expected<std::optional<ChosenModel>> choose_model(std::span<const std::string> paths,
                                                  const std::string& holder) {
  auto candidates = candidates_in(paths);
  if (candidates.empty()) return std::nullopt;
  const std::size_t all = candidates.size();
  drop_scenes(candidates);
  ChosenModel chosen{.file = candidates[0].file};
  if (all == 1) return chosen;
  if (!are_one_model(candidates)) return too_many(paths, candidates, holder);
  chosen.note = "read " + in_quotes(paths[chosen.file]) + " of the " + counted(all, "file") +
                " of the model in the " + holder + "; to publish another one, give it alone";
  return chosen;
}

Expected<PackagedModel> PackagedModel::open(std::span<const std::uint8_t> package) {
  auto files = unpack(package, is_wanted);
  if (!files) return tl::unexpected(files.error());
  PackagedModel model(*std::move(files));
  const bool is_one_file = model.files_.size() == 1 && model.name().empty();
  if (is_one_file) return model;
  const auto chosen = choose_model(paths_of(model.files_), "package");
  if (!chosen) return tl::unexpected(chosen.error());
  if (*chosen) {
    model.model_ = (*chosen)->file;
    model.note_ = (*chosen)->note;
  } else if (const auto part = only_3mf_part(model.files_)) {
    model.model_ = *part;
  } else {
    return no_model(package, model.files_);
  }
  return model.with_named_files(package);
}

bool PackagedModel::is_companion(std::string_view path) const {
  return is_wanted(path) || named_.contains(name_key(path));
}

Expected<PackagedModel> PackagedModel::with_named_files(std::span<const std::uint8_t> package) {
  named_ = files_of_gltf(bytes());
  const bool are_whole = std::ranges::all_of(files_, [&](const PackedFile& file) {
    return is_wanted(file.path) || !is_companion(file.path);
  });
  if (are_whole) return std::move(*this);
  const std::string path(name());
  files_.clear();  // saves memory
  auto files = unpack(package, [&](std::string_view other) { return is_companion(other); });
  if (!files) return tl::unexpected(files.error());
  files_ = *std::move(files);
  const auto at = std::ranges::find(files_, path, &PackedFile::path);
  model_ = static_cast<std::size_t>(at - files_.begin());
  return std::move(*this);
}

Companions PackagedModel::beside() const {
  Companions companions;
  for (const PackedFile& file : files_) {
    if (is_companion(file.path))
      companions.emplace(companion_key(relative_path(name(), file.path)), file.bytes);
  }
  share_equal_contents(companions);
  return companions;
}

}  // namespace vitrine::inline codec
