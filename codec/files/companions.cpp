// SPDX-License-Identifier: Apache-2.0
#include "codec/files/companions.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <compare>
#include <optional>
#include <vector>

#include "codec/core/printable.h"
#include "codec/files/composed.h"
#include "codec/files/picture_formats.h"

namespace vitrine::inline codec {

namespace {

// The Unicode characters of the windows-1252 bytes 0x80 to 0x9F. All other bytes are the characters
// with the same numbers. Bytes without a character become U+FFFD.
constexpr std::array<std::uint16_t, 32> kWindows1252{
    0x20AC, 0xFFFD, 0x201A, 0x0192, 0x201E, 0x2026, 0x2020, 0x2021, 0x02C6, 0x2030, 0x0160,
    0x2039, 0x0152, 0xFFFD, 0x017D, 0xFFFD, 0xFFFD, 0x2018, 0x2019, 0x201C, 0x201D, 0x2022,
    0x2013, 0x2014, 0x02DC, 0x2122, 0x0161, 0x203A, 0x0153, 0xFFFD, 0x017E, 0x0178};

// Appends a character below U+10000 as UTF-8.
void append_utf8(std::uint32_t c, std::string& out) {
  if (c < 0x80) {
    out += static_cast<char>(c);
  } else if (c < 0x800) {
    out += {static_cast<char>(0xC0 | c >> 6), static_cast<char>(0x80 | (c & 0x3F))};
  } else {
    out += {static_cast<char>(0xE0 | c >> 12), static_cast<char>(0x80 | (c >> 6 & 0x3F)),
            static_cast<char>(0x80 | (c & 0x3F))};
  }
}

std::string folded(std::string_view text) {
  std::string out = composed(as_utf8(text));
  for (char& c : out)
    c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  return out;
}

// Returns the parts of a path. Drops empty parts and ".". A ".." after a folder removes this
// folder.
std::vector<std::string_view> parts_of(std::string_view path) {
  std::vector<std::string_view> parts;
  while (!path.empty()) {
    const std::size_t end = std::min(path.find_first_of("/\\"), path.size());
    const std::string_view part = path.substr(0, end);
    path.remove_prefix(std::min(end + 1, path.size()));
    if (part == ".." && !parts.empty() && parts.back() != "..") {
      parts.pop_back();
    } else if (!part.empty() && part != ".") {
      parts.push_back(part);
    }
  }
  return parts;
}

std::string reversed(const std::vector<std::string_view>& parts) {
  std::string out;
  for (auto part = parts.rbegin(); part != parts.rend(); ++part)
    (out += out.empty() ? "" : "/") += *part;
  return out;
}

// Largest number of files with the same name among which find_companion() chooses. It bounds the
// time that a hostile file can cost.
constexpr std::size_t kMostNamesakes = 256;

// How well a companion fits a stated path. Larger values are better; earlier members matter more.
struct Fit {
  std::size_t equal_parts;  // number of equal parts at the ends of both paths
  int nearness;             // 2 in the folder of the mesh file, 1 below it, 0 elsewhere
  std::ptrdiff_t folders;   // minus the number of folders in the path

  auto operator<=>(const Fit&) const = default;
};

Fit fit_of(std::string_view key, std::string_view stated_key) {
  Fit fit{.equal_parts = 0, .nearness = 1, .folders = -std::ranges::count(key, '/')};
  if (key.ends_with("/..")) fit.nearness = 0;
  if (key.find('/') == key.npos) fit.nearness = 2;
  while (!key.empty()) {
    const std::string_view part = key.substr(0, key.find('/'));
    if (part == ".." || part != stated_key.substr(0, stated_key.find('/'))) break;
    ++fit.equal_parts;
    key.remove_prefix(std::min(part.size() + 1, key.size()));
    stated_key.remove_prefix(std::min(part.size() + 1, stated_key.size()));
  }
  return fit;
}

using Found = std::vector<const Companions::value_type*>;

// Returns the companions that have the same file name as `path`.
Found namesakes(const Companions& companions, std::string_view path) {
  Found found;
  const std::string name = name_key(path), start = name + '/';
  if (const auto here = companions.find(name); here != companions.end()) found.push_back(&*here);
  for (auto it = companions.lower_bound(start);
       it != companions.end() && it->first.starts_with(start) && found.size() <= kMostNamesakes;
       ++it)
    found.push_back(&*it);
  return found;
}

Unexpected ambiguous(const Found& best) {
  return fail(ErrorCode::kBadInput,
              "has the name of " + std::to_string(best.size()) +
                  " files beside the mesh file, such as " +
                  in_quotes(companion_path(best[0]->first)) + " and " +
                  in_quotes(companion_path(best[1]->first)) +
                  "; state the path of one of them, or give the files different names");
}

// Finds a companion by rules 3 to 5 of find_companion().
Expected<const Companions::value_type*> find_by_name(const Companions& companions,
                                                     std::string_view path) {
  const auto candidates = namesakes(companions, path);
  if (candidates.empty())
    return fail(ErrorCode::kBadInput,
                "is not beside the mesh file; copy it there, or pack both in one zip");
  const std::string stated_key = companion_key(path);
  if (candidates.size() > kMostNamesakes) return ambiguous(candidates);
  Found best;
  std::optional<Fit> most;
  for (const auto* candidate : candidates) {
    const Fit fit = fit_of(candidate->first, stated_key);
    if (fit > most) most = fit, best.clear();
    if (fit == most) best.push_back(candidate);
  }
  const bool share_bytes = std::ranges::all_of(
      best, [&](const auto* other) { return other->second.data() == best[0]->second.data(); });
  if (!share_bytes) return ambiguous(best);
  return best[0];
}

}  // namespace

std::string as_utf8(std::string_view text) {
  if (is_utf8(text)) return std::string(text);
  std::string out;
  for (const char c : text) {
    const auto byte = static_cast<std::uint8_t>(c);
    append_utf8(byte >= 0x80 && byte < 0xA0 ? kWindows1252[byte - 0x80] : byte, out);
  }
  return out;
}

std::string name_key(std::string_view path) {
  const std::size_t slash = path.find_last_of("/\\");
  return folded(slash == path.npos ? path : path.substr(slash + 1));
}

std::string companion_key(std::string_view path) {
  return reversed(parts_of(folded(path)));
}

std::string companion_path(std::string_view key) {
  std::vector<std::string_view> parts;
  for (;;) {
    const std::size_t end = key.find('/');
    parts.push_back(key.substr(0, end));
    if (end == key.npos) return reversed(parts);
    key.remove_prefix(end + 1);
  }
}

void share_equal_contents(Companions& companions) {
  std::span<const std::uint8_t> before;
  for (auto& [key, bytes] : companions) {
    if (std::ranges::equal(bytes, before)) bytes = before;
    before = bytes;
  }
}

std::string percent_decoded(std::string_view uri) {
  std::string out;
  for (std::size_t i = 0; i < uri.size(); ++i) {
    std::uint8_t byte = 0;
    const char *digits = uri.data() + i + 1, *end = digits + 2;
    if (uri[i] == '%' && i + 2 < uri.size() && std::from_chars(digits, end, byte, 16).ptr == end) {
      out += static_cast<char>(byte);
      i += 2;
    } else {
      out += uri[i];
    }
  }
  return out;
}

CompanionKind companion_kind(std::string_view name) {
  const auto has_extension_of = [&](const PictureFormat& format) {
    return std::ranges::any_of(format.extensions, [&](std::string_view extension) {
      return !extension.empty() && name.ends_with(extension);
    });
  };
  if (name.ends_with(".mtl")) return CompanionKind::kLibrary;
  if (name.ends_with(".bin")) return CompanionKind::kBuffer;
  const bool is_picture = std::ranges::any_of(kReadPictures, has_extension_of) ||
                          std::ranges::any_of(kOtherPictures, has_extension_of);
  return is_picture ? CompanionKind::kPicture : CompanionKind::kOther;
}

Expected<const Companions::value_type*> find_companion(const Companions& companions,
                                                       const StatedPath& stated) {
  const std::string from_folder = as_utf8(stated.folder) + '/' + as_utf8(stated.path);
  for (const std::string_view path : {std::string_view(from_folder), stated.path}) {
    const auto it = companions.find(companion_key(path));
    if (it != companions.end()) return &*it;
  }
  return find_by_name(companions, stated.path);
}

}  // namespace vitrine::inline codec
