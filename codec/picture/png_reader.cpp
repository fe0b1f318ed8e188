// SPDX-License-Identifier: Apache-2.0
#include "codec/picture/png_reader.h"

#include <algorithm>
#include <csetjmp>
#include <cstddef>

namespace vitrine::inline codec {
namespace {

void leave_libpng(png_structp png, png_const_charp) {
  png_longjmp(png, 1);
}

void ignore_warning(png_structp, png_const_charp) {}

void copy_to_libpng(png_structp png, png_bytep out, std::size_t size) {
  auto* left = static_cast<std::span<const std::uint8_t>*>(png_get_io_ptr(png));
  if (size > left->size()) png_error(png, "the file is cut off");
  std::copy_n(left->begin(), size, out);
  *left = left->subspan(size);
}

}  // namespace

PngReader::PngReader(std::span<const std::uint8_t> bytes)
    : left_(bytes),
      png_(png_create_read_struct(PNG_LIBPNG_VER_STRING, nullptr, leave_libpng, ignore_warning)) {
  if (png_ != nullptr) info_ = png_create_info_struct(png_);
}

PngReader::~PngReader() {
  png_destroy_read_struct(&png_, &info_, nullptr);
}

// On an error, libpng jumps back to setjmp() without running destructors. begin() and read_rows()
// therefore have no local objects with destructors.
bool PngReader::read_header() {
  if (info_ == nullptr || setjmp(png_jmpbuf(png_)) != 0) return false;
  begin();
  return true;
}

bool PngReader::read_pixels(std::uint8_t* pixels) {
  if (setjmp(png_jmpbuf(png_)) != 0) return false;
  read_rows(pixels);
  return true;
}

void PngReader::begin() {
  png_set_read_fn(png_, &left_, copy_to_libpng);
  // Ignores all chunks except IHDR, PLTE, tRNS, IDAT and IEND.
  png_set_keep_unknown_chunks(png_, PNG_HANDLE_CHUNK_NEVER, nullptr, -1);
  png_read_info(png_, info_);
}

void PngReader::read_rows(std::uint8_t* pixels) {
  png_set_expand(png_);  // converts palettes, 1 to 4 bits and tRNS to 8-bit RGBA
  png_set_scale_16(png_);
  png_set_gray_to_rgb(png_);
  png_set_add_alpha(png_, 0xFF, PNG_FILLER_AFTER);
  const int passes = png_set_interlace_handling(png_);
  png_read_update_info(png_, info_);
  const std::size_t row_bytes = png_get_rowbytes(png_, info_), rows = height();
  if (row_bytes != std::size_t{4} * width()) png_error(png_, "the rows have another size");
  for (int pass = 0; pass < passes; ++pass) {
    for (std::size_t y = 0; y < rows; ++y)
      png_read_row(png_, pixels + y * row_bytes, nullptr);
  }
}

}  // namespace vitrine::inline codec
