// SPDX-License-Identifier: Apache-2.0
#include "codec/import/packaged_model.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <optional>
#include <utility>

#include "codec/import/formats.h"
#include "codec/import/other_files.h"
#include "codec/import/text_cursor.h"

namespace vitrine::inline codec {
namespace {

// File name extensions of models. Formats that can store more data come first.
constexpr std::array<std::string_view, std::size(kImportFormats)> kByContents{
    ".glb", ".gltf", ".obj", ".ply", ".3mf", ".off", ".stl"};

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

// Returns the index of the name's extension in kByContents, or nullopt if it is not listed there.
std::optional<std::size_t> model_kind(std::string_view key) {
  const auto* found = std::ranges::find_if(
      kByContents, [&](std::string_view extension) { return key.ends_with(extension); });
  if (found == kByContents.end()) return std::nullopt;
  return static_cast<std::size_t>(found - kByContents.begin());
}

bool is_package_name(std::string_view key) {
  constexpr std::array<std::string_view, 5> kPackages{".zip", ".tar", ".gz", ".tgz", ".3mf"};
  return std::ranges::any_of(kPackages,
                             [&](std::string_view extension) { return key.ends_with(extension); });
}

bool is_wanted(std::string_view path) {
  if (is_hidden(path)) return false;
  const std::string key = companion_key(path);
  return model_kind(key) || is_package_name(key) || key.ends_with(".model") ||
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
  std::size_t file;   // index in the files of the package
  std::string model;  // name without folders, extension and level-of-detail mark
  unsigned level;     // level of detail; 0 is the most detailed
  std::size_t kind;   // index in kByContents

  auto order() const { return std::pair(level, kind); }
};

Candidate candidate(std::size_t file, const std::string& path, std::size_t kind) {
  std::string name = companion_key(path);
  name.resize(name.size() - kByContents[kind].size());
  if (const auto mark = lod_mark(name)) name.erase(mark->begin, mark->size);
  const auto level = lod_mark(lower_case(path));
  return {file, name, level ? level->number : 0, kind};
}

std::vector<Candidate> candidates_in(const std::vector<PackedFile>& files) {
  std::vector<Candidate> candidates;
  for (std::size_t i = 0; i < files.size(); ++i) {
    const std::string path = visible_path(files[i].path);
    const auto kind = model_kind(companion_key(path));
    if (kind && !is_hidden(path)) candidates.push_back(candidate(i, path, *kind));
  }
  std::ranges::stable_sort(candidates, {}, &Candidate::order);
  return candidates;
}

// Whether all candidates are files of the same model, and the first candidate is better than the
// second. Candidates must be sorted by order().
bool are_one_model(const std::vector<Candidate>& candidates) {
  return std::ranges::all_of(
             candidates,
             [&](const Candidate& other) { return other.model == candidates[0].model; }) &&
         candidates[0].order() < candidates[1].order();
}

Unexpected too_many(const std::vector<PackedFile>& files,
                    const std::vector<Candidate>& candidates) {
  constexpr std::size_t kNamed = 4;
  std::string names;
  for (std::size_t i = 0; i < std::min(candidates.size(), kNamed); ++i)
    names += (i > 0 ? ", " : "") + in_quotes(files[candidates[i].file].path);
  if (candidates.size() > kNamed) names += ", ...";
  return bad_input("the package has " + counted(candidates.size(), "model") + ", " + names +
                   "; give one package or file for each of them");
}

// Returns the error for a package without a model. If the package itself is of a known, unsupported
// kind, the error names that kind. Otherwise it names the first file that is a model in an
// unsupported format. If there is none, it states the number of files.
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

// Returns two numbers of steps between folders: up from `from` to the nearest common folder, then
// down to `to`.
std::pair<std::size_t, std::size_t> way(std::string_view from, std::string_view to) {
  const auto ups = folders_of(from), downs = folders_of(to);
  const auto fork = std::ranges::mismatch(ups, downs);
  return {static_cast<std::size_t>(ups.end() - fork.in1),
          static_cast<std::size_t>(downs.end() - fork.in2)};
}

}  // namespace

Expected<PackagedModel> PackagedModel::open(std::span<const std::uint8_t> package) {
  auto files = unpack(package, is_wanted);
  if (!files) return tl::unexpected(files.error());
  PackagedModel model(*std::move(files));
  const bool is_one_file = model.files_.size() == 1 && model.name().empty();
  if (is_one_file) return model;
  const auto candidates = candidates_in(model.files_);
  if (candidates.empty()) return no_model(package, model.files_);
  model.model_ = candidates[0].file;
  if (candidates.size() == 1) return model;
  if (!are_one_model(candidates)) return too_many(model.files_, candidates);
  model.note_ = "read " + in_quotes(model.name()) + " of the " +
                counted(candidates.size(), "file") +
                " of the model in the package; to publish "
                "another one, give it alone";
  return model;
}

Companions PackagedModel::beside() const {
  std::vector<const PackedFile*> nearest;
  for (const PackedFile& file : files_) {
    if (is_wanted(file.path)) nearest.push_back(&file);
  }
  std::ranges::stable_sort(nearest, {}, [&](const PackedFile* file) {
    return std::pair(way(name(), file->path), std::string_view(file->path));
  });
  Companions companions;
  for (const PackedFile* file : nearest)
    companions.emplace(companion_key(file->path), file->bytes);
  return companions;
}

}  // namespace vitrine::inline codec
