// SPDX-License-Identifier: Apache-2.0
#include "server/cli/support/companion_files.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <vector>

#include "codec/gltf/glb_file.h"
#include "codec/import/readers.h"

namespace vitrine::server::cli {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostSearchedBytes = 1 << 20;
constexpr std::size_t kMostSearchedJson = 16 << 20;  // a glTF file may name its files at the end

std::string_view text_of(std::span<const std::uint8_t> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

std::string_view json_of(std::span<const std::uint8_t> glb) {
  const auto chunks = split_glb(glb);
  return chunks ? chunks->json : std::string_view();
}

// Returns the part of a file that may contain names, in lower case, since names are compared
// without case, and without the percent-encoding of glTF.
std::string searchable(std::span<const std::uint8_t> bytes) {
  const bool has_uris = is_glb(bytes) || is_gltf(bytes);
  const std::size_t most = has_uris ? kMostSearchedJson : kMostSearchedBytes;
  std::string text((is_glb(bytes) ? json_of(bytes) : text_of(bytes)).substr(0, most));
  for (char& c : text)
    c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  return has_uris ? percent_decoded(text) : text;
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
  return key.ends_with(".mtl");
}

bool is_buffer(const std::string& key) {
  return key.ends_with(".bin");
}

bool is_buffer_or_picture(const std::string& key) {
  constexpr std::array<std::string_view, 4> kPictures{".png", ".jpg", ".jpeg", ".webp"};
  return is_buffer(key) ||
         std::ranges::any_of(kPictures, [&](std::string_view end) { return key.ends_with(end); });
}

// Tells from the key of a file whether it is opened.
using Filter = bool (*)(const std::string& key);

// Returns the filters to use one after the other. Files that pass the first may name others.
std::vector<Filter> filters_of(CompanionKinds kinds) {
  if (kinds == CompanionKinds::kBuffers) return {is_buffer};
  return {is_library, is_buffer_or_picture};
}

}  // namespace

CompanionFiles::CompanionFiles(const std::string& path, std::span<const std::uint8_t> mesh,
                               CompanionKinds kinds) {
  const std::vector<fs::path> candidates = files_beside(path);
  std::string text = searchable(mesh);
  for (const Filter is_wanted : filters_of(kinds)) {
    std::string libraries;
    for (const fs::path& candidate : candidates) {
      const std::string key = companion_key(candidate.filename().string());
      if (!is_wanted(key) || files_.contains(key) || text.find(key) == text.npos) continue;
      auto file = InputFile::open(candidate.string());
      if (!file) continue;  // the report names it as missing
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
