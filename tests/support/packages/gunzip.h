// SPDX-License-Identifier: Apache-2.0
// Decompresses gzip files.
#pragma once

#include <zlib.h>

#include <stdexcept>
#include <string>

namespace vitrine::test {

// Returns the content of a gzip file. Throws std::runtime_error if it is damaged.
inline std::string gunzip(std::string file) {
  z_stream stream{};
  if (inflateInit2(&stream, 15 + 16) != Z_OK) throw std::runtime_error("zlib cannot start");
  std::string out;
  char piece[65536];
  stream.next_in = reinterpret_cast<Bytef*>(file.data());
  stream.avail_in = static_cast<uInt>(file.size());
  int state = Z_OK;
  while (state == Z_OK) {
    stream.next_out = reinterpret_cast<Bytef*>(piece);
    stream.avail_out = sizeof piece;
    state = inflate(&stream, Z_NO_FLUSH);
    out.append(piece, sizeof piece - stream.avail_out);
  }
  inflateEnd(&stream);
  if (state != Z_STREAM_END || stream.avail_in > 0) throw std::runtime_error("damaged gzip file");
  return out;
}

}  // namespace vitrine::test
