// SPDX-License-Identifier: Apache-2.0
#include "server/cli/support/companion_files.h"

#include <algorithm>
#include <filesystem>
#include <set>
#include <vector>

#include "codec/core/byte_cursor.h"
#include "codec/files/composed.h"
#include "codec/gltf/glb_file.h"
#include "codec/import/formats.h"
#include "codec/import/packaged_model.h"
#include "codec/import/readers.h"
#include "codec/package/unpack.h"
#include "server/cli/support/console.h"

namespace vitrine::server::cli {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostSearchedBytes = 1 << 20;
// Limit in bytes for glTF and DAE files. It is large, because they may name files at their end.
constexpr std::size_t kMostSearchedUris = 16 << 20;

std::string_view text_of(std::span<const std::uint8_t> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

std::string_view json_of(std::span<const std::uint8_t> glb) {
  const auto chunks = split_glb(glb);
  return chunks ? chunks->json : std::string_view();
}

// Converts each line to UTF-8 separately, because different programs may have written the lines in
// different encodings.
std::string lines_as_utf8(std::string_view text) {
  std::string out;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size() - 1) + 1;
    out += as_utf8(text.substr(begin, end - begin));
    begin = end;
  }
  return out;
}

// Whether `json`, the text before a JSON value, ends with the key "uri" and a colon.
bool ends_with_uri_key(std::string_view json) {
  for (const std::string_view token : {":", "\"uri\""}) {
    json = json.substr(0, json.find_last_not_of(" \t\r\n") + 1);
    if (!json.ends_with(token)) return false;
    json.remove_suffix(token.size());
  }
  return true;
}

// Returns the name_key() of each URI in the JSON of a glTF file. No other strings name files that
// the reader needs.
std::set<std::string> names_in_json(std::string_view json) {
  constexpr std::size_t kMostUriBytes = 4096;  // longer strings are data: URIs
  std::set<std::string> names;
  std::size_t begin = json.find('"');
  while (begin != json.npos) {
    const bool is_uri = ends_with_uri_key(json.substr(0, begin));
    std::size_t end = ++begin;
    while (end < json.size() && json[end] != '"')
      end += json[end] == '\\' ? 2 : 1;
    end = std::min(end, json.size());
    const std::string_view uri = json.substr(begin, end - begin);
    if (is_uri && uri.size() <= kMostUriBytes) names.insert(name_key(percent_decoded(uri)));
    begin = json.find('"', std::min(end + 1, json.size()));
  }
  return names;
}

// Returns the value of a record of an FBX file. `record` contains the bytes after the record's
// name. Returns an empty text if the value is not a text.
std::string_view text_in_fbx(std::string_view record) {
  constexpr std::size_t kMostBytes = 4096;
  constexpr std::size_t kBinaryHead = 5;  // the letter S and the size of the text
  if (record.starts_with('S') && record.size() > kBinaryHead) {
    const auto size = load<std::uint32_t>(reinterpret_cast<const std::uint8_t*>(&record[1]));
    return record.substr(kBinaryHead, std::min<std::size_t>(size, kMostBytes));
  }
  const std::size_t quote = record.find_first_not_of(": \t\r\n");
  if (quote == record.npos || record[quote] != '"') return {};
  const std::string_view value = record.substr(quote + 1, kMostBytes);
  return value.substr(0, value.find('"'));
}

// Returns the name_key() of each picture that an FBX file, binary or text, names in records such as
// RelativeFilename. Some programs write these names as in a URI, so the result also contains the
// decoded names.
std::set<std::string> names_in_fbx(std::string_view fbx) {
  std::set<std::string> names;
  for (const std::string_view record : {"FileName", "Filename"}) {
    for (std::size_t at = fbx.find(record); at != fbx.npos; at = fbx.find(record, at)) {
      at += record.size();
      const std::string_view name = text_in_fbx(fbx.substr(at));
      names.insert(name_key(name));
      names.insert(name_key(percent_decoded(name)));
    }
  }
  return names;
}

// Returns the text of a DAE file after decoding the XML and percent escapes that file names
// contain.
std::string decoded_dae(std::string_view xml) {
  std::string out;
  while (!xml.empty()) {
    const bool is_and = xml.starts_with("&amp;"), is_apostrophe = xml.starts_with("&apos;");
    out += is_and ? '&' : is_apostrophe ? '\'' : xml[0];
    xml.remove_prefix(is_and ? 5 : is_apostrophe ? 6 : 1);
  }
  return percent_decoded(out);
}

// The names of files that occur in a mesh file or its material libraries.
class Mentions {
 public:
  explicit Mentions(std::span<const std::uint8_t> mesh) : is_gltf_(is_glb(mesh) || is_gltf(mesh)) {
    const std::string_view json = is_glb(mesh) ? json_of(mesh) : text_of(mesh);
    if (is_gltf_)
      names_ = names_in_json(json.substr(0, kMostSearchedUris));
    else if (is_fbx(mesh))
      names_ = names_in_fbx(text_of(mesh));
    else
      add(mesh);
  }

  bool are_of_gltf() const { return is_gltf_; }

  // Adds the names in a text file.
  void add(std::span<const std::uint8_t> bytes) {
    if (is_dae(bytes)) return add_text(decoded_dae(text_of(bytes).substr(0, kMostSearchedUris)));
    const std::string_view text = text_of(bytes).substr(0, kMostSearchedBytes);
    add_text(lines_as_utf8(text));
    // Some programs write the names of pictures as in a URI.
    if (text.find('%') != text.npos) add_text(lines_as_utf8(percent_decoded(text)));
  }

  bool contains(const std::string& name) const {
    return names_.contains(name) || text_.find(name) != text_.npos;
  }

 private:
  // Does not use name_key(), because it would keep only the text after the last slash.
  void add_text(const std::string& utf8) {
    std::string text = composed(utf8);
    for (char& c : text)
      c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    (text_ += text) += '\n';
  }

  bool is_gltf_;
  std::set<std::string> names_;  // for glTF and FBX
  std::string text_;             // for other formats; in lower case, as names are
};

// Appends the entries of a folder in the order of their names. Omits hidden entries, such as .ssh,
// because a hostile model could name private files in them and so publish these files.
void list(const fs::path& folder, std::vector<fs::path>& entries) {
  const auto first = static_cast<std::ptrdiff_t>(entries.size());
  std::error_code error;
  for (fs::directory_iterator at(folder, error), end; !error && at != end; at.increment(error)) {
    if (!at->path().filename().string().starts_with('.')) entries.push_back(at->path());
  }
  std::sort(entries.begin() + first, entries.end());
}

// Returns the files in a folder, followed by the files in its subfolders.
std::vector<fs::path> files_in(const fs::path& folder) {
  std::vector<fs::path> files;
  list(folder, files);
  for (std::size_t i = 0, beside = files.size(); i < beside; ++i) {
    std::error_code error;
    if (fs::is_directory(files[i], error)) list(fs::path(files[i]), files);
  }
  return files;
}

std::string folder_of_file(const std::string& path) {
  const fs::path parent = fs::path(path).parent_path();
  return parent.empty() ? "." : parent.string();
}

bool is_library(const std::string& name) {
  return companion_kind(name) == CompanionKind::kLibrary;
}

bool is_picture(const std::string& name) {
  return companion_kind(name) == CompanionKind::kPicture;
}

// Whether to open a file whose name_key() is `name`.
using Filter = bool (*)(const std::string& name);

// Returns the filters in the order of their use. Files that pass one filter may name files that
// pass the next filter. The buffers of a glTF file may have names with any extension.
std::vector<Filter> filters_of(CompanionKinds kinds, bool is_gltf) {
  if (!is_gltf && kinds == CompanionKinds::kBuffers) return {};
  if (!is_gltf) return {is_library, is_picture};
  if (kinds == CompanionKinds::kAll) return {[](const std::string&) { return true; }};
  return {[](const std::string& name) { return !is_picture(name); }};
}

}  // namespace

Expected<ModelPath> ModelPath::of(const std::string& path) {
  std::error_code error;  // ignored: opening the file reports it
  if (!fs::is_directory(path, error)) return ModelPath{path, folder_of_file(path)};
  std::vector<std::string> names;
  for (const fs::path& file : files_in(path))
    names.push_back(file.lexically_relative(path).string());
  const auto chosen = choose_model(names, "folder");
  if (!chosen) return tl::unexpected(chosen.error());
  if (!*chosen)
    return fail(ErrorCode::kBadInput, path +
                                          " is a folder without a model; give a file or folder "
                                          "with a mesh as " +
                                          std::string(kImportFormatNames));
  if (!(*chosen)->note.empty()) print_note((*chosen)->note);
  return ModelPath{(fs::path(path) / names[(*chosen)->file]).string(), path};
}

CompanionFiles::CompanionFiles(const std::string& path, std::span<const std::uint8_t> mesh,
                               CompanionKinds kinds)
    : CompanionFiles(ModelPath{path, folder_of_file(path)}, mesh, kinds) {}

CompanionFiles::CompanionFiles(const ModelPath& path, std::span<const std::uint8_t> mesh,
                               CompanionKinds kinds) {
  if (is_package(mesh)) return;
  const fs::path folder = folder_of_file(path.file);
  const std::vector<fs::path> candidates = files_in(path.folder);
  Mentions mentions(without_mark(mesh));
  for (const Filter is_wanted : filters_of(kinds, mentions.are_of_gltf())) {
    std::vector<const InputFile*> libraries;
    for (const fs::path& candidate : candidates) {
      const std::string name = name_key(candidate.filename().string());
      if (!is_wanted(name) || !mentions.contains(name)) continue;
      auto file = InputFile::open(candidate.string());
      if (!file) continue;  // the reader reports the file as missing
      const std::string key = companion_key(candidate.lexically_relative(folder).string());
      const auto [at, is_new] = files_.try_emplace(key, std::move(*file));
      if (is_new && is_library(name)) libraries.push_back(&at->second);
    }
    for (const InputFile* library : libraries)
      mentions.add(library->bytes());
  }
}

Companions CompanionFiles::contents() const {
  Companions contents;
  for (const auto& [key, file] : files_)
    contents.emplace(key, file.bytes());
  share_equal_contents(contents);
  return contents;
}

}  // namespace vitrine::server::cli
