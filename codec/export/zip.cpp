// SPDX-License-Identifier: Apache-2.0
// Writes zip archives without libarchive, which cannot align files. libarchive also writes a file's
// checksum and sizes after the file's bytes. Readers of USDZ do not find them there, and strict
// readers of 3MF refuse such archives.
#include "codec/export/zip.h"

#include <zlib.h>

#include <limits>
#include <memory>
#include <new>

#include "codec/export/file_writer.h"

namespace vitrine::inline codec {
namespace {

using Bytes = std::vector<std::uint8_t>;

enum class Method : std::uint16_t { kStored = 0, kDeflated = 8 };

constexpr std::size_t kLocalHead = 30, kDirectoryHead = 46, kEnd = 22, kExtraHead = 4;
constexpr std::uint16_t kVersion = 20;      // zip version 2.0, which introduced deflate
constexpr std::uint16_t kFirstDay = 0x21;   // 1 January 1980
constexpr std::uint16_t kPadding = 0x1986;  // identifier of OpenUSD's extra field

Bytes deflated(const Bytes& bytes) {
  constexpr int kFast = 1, kRawWindowBits = -15, kMemoryLevel = 8;
  z_stream stream{};
  if (deflateInit2(&stream, kFast, Z_DEFLATED, kRawWindowBits, kMemoryLevel, Z_DEFAULT_STRATEGY) !=
      Z_OK)
    throw std::bad_alloc();
  const std::unique_ptr<z_stream, decltype(&deflateEnd)> closer(&stream, deflateEnd);
  Bytes out(deflateBound(&stream, bytes.size()));
  stream.next_in = const_cast<Bytef*>(bytes.data());
  stream.avail_in = static_cast<uInt>(bytes.size());
  stream.next_out = out.data();
  stream.avail_out = static_cast<uInt>(out.size());
  if (deflate(&stream, Z_FINISH) != Z_STREAM_END) throw std::bad_alloc();
  out.resize(stream.total_out);
  out.shrink_to_fit();
  return out;
}

// Returns the size of the extra field that begins at byte `at` of the archive. The field is
// padding, after which the bytes of the file begin at a multiple of `alignment`.
std::size_t padding_at(std::size_t at, std::size_t alignment) {
  const std::size_t padding = (alignment - at % alignment) % alignment;
  return padding > 0 && padding < kExtraHead ? padding + alignment : padding;
}

class ZipWriter {
 public:
  ZipWriter(Method method, std::size_t alignment, std::size_t expected_size)
      : method_(method), alignment_(alignment), out_(expected_size), directory_(1024) {}

  // `body` holds the file's bytes in the form in which the compression method stores them.
  void add(const MeshFile& file, const Bytes& body) {
    const std::size_t at = out_.size();
    const std::size_t padding = padding_at(at + kLocalHead + file.name.size(), alignment_);
    const auto checksum =
        static_cast<std::uint32_t>(crc32_z(0, file.bytes.data(), file.bytes.size()));
    out_.text("PK\3\4");
    put_shared_fields(out_, file, body, checksum, padding);
    out_.text(file.name);
    put_padding(padding);
    out_.text({reinterpret_cast<const char*>(body.data()), body.size()});
    put_directory_entry(file, body, checksum, at);
    ++count_;
  }

  Bytes take() {
    const auto at = static_cast<std::uint32_t>(out_.size());
    const Bytes directory = directory_.take();
    out_.text({reinterpret_cast<const char*>(directory.data()), directory.size()});
    out_.text("PK\5\6");
    out_.put(std::uint32_t{0});  // numbers of this disk and of the directory's disk
    out_.put(count_), out_.put(count_);
    out_.put(static_cast<std::uint32_t>(directory.size()));
    out_.put(at);
    out_.put(std::uint16_t{0});  // size of the comment
    return out_.take();
  }

 private:
  // Writes the fields that a file's local header has in common with its entry in the directory.
  void put_shared_fields(FileWriter& out, const MeshFile& file, const Bytes& body,
                         std::uint32_t checksum, std::size_t padding) const {
    out.put(kVersion);
    out.put(std::uint16_t{0});  // flags
    out.put(method_);
    out.put(std::uint16_t{0});  // time
    out.put(kFirstDay);
    out.put(checksum);
    out.put(static_cast<std::uint32_t>(body.size()));
    out.put(static_cast<std::uint32_t>(file.bytes.size()));
    out.put(static_cast<std::uint16_t>(file.name.size()));
    out.put(static_cast<std::uint16_t>(padding));
  }

  void put_padding(std::size_t size) {
    if (size == 0) return;
    out_.put(kPadding);
    out_.put(static_cast<std::uint16_t>(size - kExtraHead));
    for (std::size_t i = kExtraHead; i < size; ++i)
      out_.put(std::uint8_t{0});
  }

  void put_directory_entry(const MeshFile& file, const Bytes& body, std::uint32_t checksum,
                           std::size_t at) {
    directory_.text("PK\1\2");
    directory_.put(kVersion);  // version of the writer
    put_shared_fields(directory_, file, body, checksum, 0);
    directory_.put(std::uint16_t{0});  // size of the comment
    directory_.put(std::uint16_t{0});  // number of the disk
    directory_.put(std::uint16_t{0});  // internal attributes
    directory_.put(std::uint32_t{0});  // external attributes
    directory_.put(static_cast<std::uint32_t>(at));
    directory_.text(file.name);
  }

  Method method_;
  std::size_t alignment_;
  FileWriter out_, directory_;
  std::uint16_t count_ = 0;
};

// Returns an upper bound of the archive's size, not counting the bytes of the files.
std::size_t most_overhead(std::span<const MeshFile> files, std::size_t alignment) {
  std::size_t bytes = kEnd;
  for (const MeshFile& file : files)
    bytes += kLocalHead + kDirectoryHead + 2 * file.name.size() + 2 * alignment;
  return bytes;
}

// Checks that all sizes and offsets fit in 32 bits, even if deflate makes the files a little
// larger.
Expected<void> check_size(std::span<const MeshFile> files, std::size_t overhead) {
  std::size_t most = overhead;
  for (const MeshFile& file : files)
    most += file.bytes.size() + file.bytes.size() / 1000 + 1000;
  if (most <= std::numeric_limits<std::uint32_t>::max()) return {};
  return fail(ErrorCode::kLimit,
              "the files are too large for a zip; ask for fewer triangles or smaller pictures");
}

}  // namespace

Expected<std::vector<std::uint8_t>> zip(std::span<const MeshFile> files) {
  std::size_t size = most_overhead(files, 1);
  if (auto ok = check_size(files, size); !ok) return tl::unexpected(ok.error());
  std::vector<Bytes> bodies;
  for (const MeshFile& file : files)
    size += bodies.emplace_back(deflated(file.bytes)).size();
  ZipWriter writer(Method::kDeflated, 1, size);
  for (std::size_t i = 0; i < files.size(); ++i)
    writer.add(files[i], bodies[i]);
  return writer.take();
}

Expected<std::vector<std::uint8_t>> stored_zip(std::span<const MeshFile> files) {
  constexpr std::size_t kAlignment = 64;
  std::size_t size = most_overhead(files, kAlignment);
  if (auto ok = check_size(files, size); !ok) return tl::unexpected(ok.error());
  for (const MeshFile& file : files)
    size += file.bytes.size();
  ZipWriter writer(Method::kStored, kAlignment, size);
  for (const MeshFile& file : files)
    writer.add(file, file.bytes);
  return writer.take();
}

}  // namespace vitrine::inline codec
