// SPDX-License-Identifier: Apache-2.0
// Fuzzes the code that reads an untrusted backup: the archive, and the checksums inside it.
#include <sys/mman.h>
#include <unistd.h>

#include <cstdint>
#include <string>

#include "codec/files/file_descriptor.h"
#include "fuzz/checks.h"
#include "server/backup/checksums.h"
#include "server/backup/tar.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace vitrine;
  using namespace vitrine::server;
  const FileDescriptor file(::memfd_create("backup", MFD_CLOEXEC));
  fuzz::require(file && ::write(file.get(), data, size) == static_cast<ssize_t>(size));
  auto reader = TarReader::open("/proc/self/fd/" + std::to_string(file.get()));
  while (reader) {
    const auto entry = reader->next();
    if (!entry || !*entry) break;
    fuzz::require((*entry)->bytes.size() <= size);  // no file is longer than its archive
    const auto sums = parse_checksums((*entry)->bytes);
    if (!sums) continue;
    const std::string text = to_text(*sums);
    fuzz::require(
        parse_checksums({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()}) == sums);
  }
  return 0;
}
