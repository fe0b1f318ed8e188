// SPDX-License-Identifier: Apache-2.0
#include "codec/files/companions.h"

#include <algorithm>
#include <array>
#include <charconv>

namespace vitrine::inline codec {

namespace {

// Returns the length in bytes of the UTF-8 character at the start of `text`, or 0 if `text` does
// not start with one. Accepts overlong encodings.
std::size_t utf8_size(std::string_view text) {
  const auto first = static_cast<std::uint8_t>(text[0]);
  const std::size_t size = first < 0x80   ? 1
                           : first < 0xC2 ? 0
                           : first < 0xE0 ? 2
                           : first < 0xF0 ? 3
                           : first < 0xF5 ? 4
                                          : 0;
  if (size > text.size()) return 0;
  for (std::size_t i = 1; i < size; ++i) {
    if ((static_cast<std::uint8_t>(text[i]) & 0xC0) != 0x80) return 0;
  }
  return size;
}

bool is_utf8(std::string_view text) {
  while (!text.empty()) {
    const std::size_t size = utf8_size(text);
    if (size == 0) return false;
    text.remove_prefix(size);
  }
  return true;
}

// The Unicode characters of the windows-1252 bytes 0x80 to 0x9F. Each other byte stands for the
// character with the same number. Bytes without a character become U+FFFD.
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

std::string companion_key(std::string_view path) {
  const std::size_t slash = path.find_last_of("/\\");
  std::string key = as_utf8(slash == path.npos ? path : path.substr(slash + 1));
  for (char& c : key)
    c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  return key;
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

CompanionKind companion_kind(std::string_view key) {
  constexpr std::array<std::string_view, 13> kPictures{".png",  ".jpg", ".jpeg", ".webp", ".tif",
                                                       ".tiff", ".tga", ".bmp",  ".gif",  ".dds",
                                                       ".psd",  ".exr", ".ktx2"};
  const auto ends = [&](std::string_view extension) { return key.ends_with(extension); };
  if (ends(".mtl")) return CompanionKind::kLibrary;
  if (ends(".bin")) return CompanionKind::kBuffer;
  return std::ranges::any_of(kPictures, ends) ? CompanionKind::kPicture : CompanionKind::kOther;
}

std::optional<std::span<const std::uint8_t>> find_companion(const Companions& companions,
                                                            std::string_view path) {
  const auto it = companions.find(companion_key(path));
  return it == companions.end() ? std::nullopt : std::optional(it->second);
}

}  // namespace vitrine::inline codec
