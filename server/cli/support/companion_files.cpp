// SPDX-License-Identifier: Apache-2.0
#include "server/cli/support/companion_files.h"

#include <algorithm>
#include <filesystem>
#include <vector>

#include "codec/gltf/glb_file.h"
#include "codec/import/readers.h"
#include "codec/package/unpack.h"

namespace vitrine::server::cli {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostSearchedBytes = 1 << 20;
// Limit in bytes. It is large, because a glTF file may name files at the end of its JSON.
constexpr std::size_t kMostSearchedJson = 16 << 20;

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

// Returns the part of a file that may name other files. The result is in lower case, because names
// are compared without regard to case. Converts each line to UTF-8, the encoding of the names.
// Decodes the percent-encoding of glTF.
std::string searchable(std::span<const std::uint8_t> bytes) {
  const bool has_uris = is_glb(bytes) || is_gltf(bytes);
  const std::size_t most = has_uris ? kMostSearchedJson : kMostSearchedBytes;
  std::string text((is_glb(bytes) ? json_of(bytes) : text_of(bytes)).substr(0, most));
  for (char& c : text)
    c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  return has_uris ? percent_decoded(text) : lines_as_utf8(text);
}

// Appends the entries of a folder in the order of their names.
void list(const fs::path& folder, std::vector<fs::path>& entries) {
  const auto first = static_cast<std::ptrdiff_t>(entries.size());
  std::error_code error;
  for (fs::directory_iterator at(folder, error), end; !error && at != end; at.increment(error))
    entries.push_back(at->path());
  std::sort(entries.begin() + first, entries.end());
}

// Returns the files in the folder of `path`, followed by those in its subfolders.
std::vector<fs::path> files_beside(const std::string& path) {
  std::vector<fs::path> files;
  const fs::path folder = fs::path(path).parent_path();
  list(folder.empty() ? "." : folder, files);
  for (std::size_t i = 0, beside = files.size(); i < beside; ++i) {
    std::error_code error;
    if (fs::is_directory(files[i], error)) list(fs::path(files[i]), files);
  }
  return files;
}

bool is_library(const std::string& key) {
  return companion_kind(key) == CompanionKind::kLibrary;
}

bool is_buffer(const std::string& key) {
  return companion_kind(key) == CompanionKind::kBuffer;
}

bool is_buffer_or_picture(const std::string& key) {
  return is_buffer(key) || companion_kind(key) == CompanionKind::kPicture;
}

// Decides whether the file with this key is opened.
using Filter = bool (*)(const std::string& key);

// Returns the filters in the order of their use. Files that pass one filter may name files that
// pass the next filter.
std::vector<Filter> filters_of(CompanionKinds kinds) {
  if (kinds == CompanionKinds::kBuffers) return {is_buffer};
  return {is_library, is_buffer_or_picture};
}

}  // namespace

CompanionFiles::CompanionFiles(const std::string& path, std::span<const std::uint8_t> mesh,
                               CompanionKinds kinds) {
  if (is_package(mesh)) return;
  const std::vector<fs::path> candidates = files_beside(path);
  std::string text = searchable(mesh);
  for (const Filter is_wanted : filters_of(kinds)) {
    std::string libraries;
    for (const fs::path& candidate : candidates) {
      const std::string key = companion_key(candidate.filename().string());
      if (!is_wanted(key) || files_.contains(key) || text.find(key) == text.npos) continue;
      auto file = InputFile::open(candidate.string());
      if (!file) continue;  // the reader reports the file as missing
      if (is_library(key)) libraries += searchable(file->bytes()) + '\n';
      files_.emplace(key, std::move(*file));
    }
    text += libraries;
  }
}

Companions CompanionFiles::contents() const {
  Companions contents;
  for (const auto& [key, file] : files_)
    contents.emplace(key, file.bytes());
  return contents;
}

}  // namespace vitrine::server::cli
