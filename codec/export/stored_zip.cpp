// SPDX-License-Identifier: Apache-2.0
// libarchive can store files, but not align them, and it writes their checksums after their bytes,
// where readers of USDZ do not look.
#include "codec/export/stored_zip.h"

#include <zlib.h>

#include <limits>

#include "codec/export/file_writer.h"

namespace vitrine::inline codec {
namespace {

constexpr std::size_t kAlignment = 64;
constexpr std::size_t kLocalHead = 30, kDirectoryHead = 46, kEnd = 22, kPaddingHead = 4;

// Returns the size of the extra field that moves the bytes of a file to an aligned place, if the
// field begins at `at`.
std::size_t padding_at(std::size_t at) {
  const std::size_t padding = (kAlignment - at % kAlignment) % kAlignment;
  return padding > 0 && padding < kPaddingHead ? padding + kAlignment : padding;
}

// Writes an extra field of zeros. Its identifier is the one of OpenUSD.
void put_padding(FileWriter& out, std::size_t size) {
  if (size == 0) return;
  out.put(std::uint16_t{0x1986});
  out.put(static_cast<std::uint16_t>(size - kPaddingHead));
  for (std::size_t i = kPaddingHead; i < size; ++i)
    out.put(std::uint8_t{0});
}

// Writes the fields that the local header of a file has in common with its entry in the directory.
void put_shared_fields(FileWriter& out, const MeshFile& file, std::uint32_t checksum,
                       std::size_t padding) {
  out.put(std::uint16_t{10});    // version 1.0 of zip suffices
  out.put(std::uint16_t{0});     // flags
  out.put(std::uint16_t{0});     // method: stored
  out.put(std::uint16_t{0});     // time
  out.put(std::uint16_t{0x21});  // 1 January 1980, the first day of zip
  out.put(checksum);
  out.put(static_cast<std::uint32_t>(file.bytes.size()));  // compressed
  out.put(static_cast<std::uint32_t>(file.bytes.size()));
  out.put(static_cast<std::uint16_t>(file.name.size()));
  out.put(static_cast<std::uint16_t>(padding));
}

void put_directory_entry(FileWriter& out, const MeshFile& file, std::uint32_t checksum,
                         std::size_t at) {
  out.text("PK\1\2");
  out.put(std::uint16_t{10});  // version of the writer
  put_shared_fields(out, file, checksum, 0);
  out.put(std::uint16_t{0});  // size of the comment
  out.put(std::uint16_t{0});  // disk
  out.put(std::uint16_t{0});  // internal attributes
  out.put(std::uint32_t{0});  // external attributes
  out.put(static_cast<std::uint32_t>(at));
  out.text(file.name);
}

// Returns an upper bound of the archive's size.
std::size_t most_bytes(std::span<const MeshFile> files) {
  std::size_t bytes = kEnd;
  for (const MeshFile& file : files)
    bytes +=
        kLocalHead + kDirectoryHead + 2 * file.name.size() + 2 * kAlignment + file.bytes.size();
  return bytes;
}

}  // namespace

Expected<std::vector<std::uint8_t>> stored_zip(std::span<const MeshFile> files) {
  const std::size_t most = most_bytes(files);
  if (most > std::numeric_limits<std::uint32_t>::max()) {
    return fail(ErrorCode::kLimit,
                "the package would be larger than 4 GiB; ask for fewer triangles or smaller "
                "pictures");
  }
  FileWriter out(most), directory(kEnd + files.size() * 256);
  for (const MeshFile& file : files) {
    const std::size_t at = out.size(), padding = padding_at(at + kLocalHead + file.name.size());
    const auto checksum =
        static_cast<std::uint32_t>(crc32_z(0, file.bytes.data(), file.bytes.size()));
    out.text("PK\3\4");
    put_shared_fields(out, file, checksum, padding);
    out.text(file.name);
    put_padding(out, padding);
    out.text({reinterpret_cast<const char*>(file.bytes.data()), file.bytes.size()});
    put_directory_entry(directory, file, checksum, at);
  }
  const auto count = static_cast<std::uint16_t>(files.size());
  const auto size = static_cast<std::uint32_t>(directory.size());
  const auto at = static_cast<std::uint32_t>(out.size());
  const std::vector<std::uint8_t> entries = directory.take();
  out.text({reinterpret_cast<const char*>(entries.data()), entries.size()});
  out.text("PK\5\6");
  out.put(std::uint32_t{0});  // numbers of this disk and of the directory's disk
  out.put(count), out.put(count);
  out.put(size), out.put(at);
  out.put(std::uint16_t{0});  // size of the comment
  return out.take();
}

}  // namespace vitrine::inline codec
