// SPDX-License-Identifier: Apache-2.0
#include "codec/package/gunzip.h"

#include <zlib.h>

#include <algorithm>
#include <limits>
#include <memory>
#include <string>

namespace vitrine::inline codec {
namespace {

constexpr std::size_t kBlock = 1 << 16;

// Passes the next part of the input to the decompressor. zlib takes at most 4 GB at once.
void give_input(z_stream& stream, std::span<const std::uint8_t>& bytes) {
  if (stream.avail_in > 0) return;
  const auto count = std::min<std::size_t>(bytes.size(), std::numeric_limits<uInt>::max());
  stream.next_in = const_cast<Bytef*>(bytes.data());
  stream.avail_in = static_cast<uInt>(count);
  bytes = bytes.subspan(count);
}

// Whether another gzip member follows in the input.
bool has_next_member(const z_stream& stream) {
  return is_gzip({stream.next_in, stream.avail_in});
}

}  // namespace

bool is_gzip(std::span<const std::uint8_t> bytes) {
  return bytes.size() >= 3 && bytes[0] == 0x1F && bytes[1] == 0x8B && bytes[2] == Z_DEFLATED;
}

Expected<std::vector<std::uint8_t>> gunzip(std::span<const std::uint8_t> bytes,
                                           std::uint64_t most) {
  constexpr int kGzip = 16 + MAX_WBITS;
  z_stream stream{};
  if (::inflateInit2(&stream, kGzip) != Z_OK)
    return fail(ErrorCode::kLimit, "memory ran out; free some and try again");
  const std::unique_ptr<z_stream, decltype(&::inflateEnd)> end(&stream, ::inflateEnd);
  std::vector<std::uint8_t> out, block(kBlock);
  for (;;) {
    give_input(stream, bytes);
    stream.next_out = block.data();
    stream.avail_out = kBlock;
    const int result = ::inflate(&stream, Z_NO_FLUSH);
    out.insert(out.end(), block.begin(), block.end() - stream.avail_out);
    if (out.size() > most)
      return fail(ErrorCode::kLimit, "the gzip package unpacks to more than " +
                                         std::to_string(most) + " bytes; give the model itself");
    if (result == Z_OK) continue;
    if (result != Z_STREAM_END)
      return fail(ErrorCode::kBadInput,
                  "the gzip package is damaged or cut short; download or pack it again");
    give_input(stream, bytes);
    if (!has_next_member(stream)) return out;
    ::inflateReset(&stream);
  }
}

}  // namespace vitrine::inline codec
