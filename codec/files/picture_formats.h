// SPDX-License-Identifier: Apache-2.0
// The table of picture formats: those that can be read, and others that messages can name.
#pragma once

#include <array>
#include <cstddef>
#include <string_view>

namespace vitrine::inline codec {

// A byte sequence at an offset of a file that identifies a picture format.
struct PictureSignature {
  std::size_t at = 0;
  std::string_view magic = {};  // empty in unused entries
};

struct PictureFormat {
  std::string_view type;                         // media type
  std::array<std::string_view, 5> extensions;    // in lower case; unused entries are empty
  std::array<PictureSignature, 4> signatures{};  // not needed for formats that are read
};

inline constexpr std::array<PictureFormat, 6> kReadPictures{{
    {"image/png", {".png"}},
    {"image/jpeg", {".jpg", ".jpeg", ".jpe", ".jfif"}},
    {"image/webp", {".webp"}},
    {"image/tiff", {".tif", ".tiff"}},
    {"image/bmp", {".bmp", ".dib"}},
    {"image/x-tga", {".tga"}},
}};

inline constexpr std::array<PictureFormat, 11> kOtherPictures{{
    {"image/ktx2", {".ktx2"}, {{{0, "\xABKTX 20"}}}},
    {"image/ktx", {".ktx"}, {{{0, "\xABKTX 11"}}}},
    {"image/avif", {".avif"}, {{{4, "ftypavif"}}}},
    {"image/heic", {".heic", ".heif", ".hif"}, {{{4, "ftyphei"}, {4, "ftyphev"}, {4, "ftypmif1"}}}},
    {"image/jp2",
     {".jp2", ".j2k", ".j2c", ".jpf", ".jpx"},
     {{{4, "jP  "}, {0, "\xFF\x4F\xFF\x51"}}}},
    {"image/jxl", {".jxl"}, {{{0, "\xFF\x0A"}, {4, "JXL "}}}},
    {"image/vnd.adobe.photoshop", {".psd", ".psb"}, {{{0, "8BPS"}}}},
    {"image/x-exr", {".exr"}, {{{0, "\x76\x2F\x31\x01"}}}},
    {"image/vnd.radiance", {".hdr", ".rgbe"}, {{{0, "#?RADIANCE"}, {0, "#?RGBE"}}}},
    {"image/gif", {".gif"}, {{{0, "GIF8"}}}},
    {"image/vnd-ms.dds", {".dds"}, {{{0, "DDS "}}}},
}};

}  // namespace vitrine::inline codec
