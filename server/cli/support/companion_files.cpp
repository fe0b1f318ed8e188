// SPDX-License-Identifier: Apache-2.0
#include "server/cli/support/companion_files.h"

#include <algorithm>
#include <filesystem>
#include <vector>

namespace vitrine::server::cli {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostSearchedBytes = 1 << 20;

// Returns the start of a file in lower case, since names are compared without case.
std::string searchable(std::span<const std::uint8_t> bytes) {
  const auto head = bytes.first(std::min(bytes.size(), kMostSearchedBytes));
  std::string text(head.begin(), head.end());
  for (char& c : text)
    c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  return text;
}

std::vector<fs::path> files_beside(const std::string& path) {
  std::vector<fs::path> files;
  const fs::path folder = fs::path(path).parent_path();
  std::error_code error;
  for (fs::directory_iterator at(folder.empty() ? "." : folder, error), end; !error && at != end;
       at.increment(error)) {
    files.push_back(at->path());
  }
  return files;
}

bool is_library(const std::string& key) {
  return key.ends_with(".mtl");
}

bool is_picture(const std::string& key) {
  return key.ends_with(".png") || key.ends_with(".jpg") || key.ends_with(".jpeg");
}

}  // namespace

CompanionFiles::CompanionFiles(const std::string& path, std::span<const std::uint8_t> mesh) {
  const std::vector<fs::path> candidates = files_beside(path);
  std::string text = searchable(mesh);
  for (const auto is_wanted : {is_library, is_picture}) {
    std::string libraries;
    for (const fs::path& candidate : candidates) {
      const std::string key = companion_key(candidate.filename().string());
      if (!is_wanted(key) || text.find(key) == text.npos) continue;
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
