// SPDX-License-Identifier: Apache-2.0
#include "codec/package/unpack.h"

#include "codec/import/packaged_model.h"
#include "fuzz/bounded.h"
#include "fuzz/checks.h"

namespace {

using vitrine::fuzz::require;

// Memory bound: the unpacked files, the packages inside them while those are unpacked, growing
// vectors, and the lists of paths.
constexpr vitrine::test::HeapBound kHeap{.always = 1 << 20,
                                         .per_byte = 8 * vitrine::kMostUnpackedPerByte};

void check_path(const std::string& path) {
  require(path.find("/../") == path.npos && !path.starts_with("../") && !path.starts_with('/'));
  for (const char c : path)
    require(static_cast<unsigned char>(c) >= ' ' && c != 0x7F && c != '\\');
}

void check_unpacked(std::span<const std::uint8_t> bytes) {
  const auto files = vitrine::unpack(bytes, [](std::string_view) { return true; });
  if (!files) return require(files.error().message.find('\n') == std::string::npos);
  std::uint64_t total = 0;
  for (const vitrine::PackedFile& file : *files) {
    total += file.bytes.size();
    check_path(file.path);
  }
  require(total <= vitrine::kMostUnpackedPerByte * bytes.size());
}

void check_model(std::span<const std::uint8_t> bytes) {
  const auto model = vitrine::PackagedModel::open(bytes);
  if (!model) return require(model.error().message.find('\n') == std::string::npos);
  const auto beside = model->beside();
  for (const auto& [key, companion] : beside)
    require(vitrine::find_companion(beside, {vitrine::companion_path(key)}).has_value());
}

}  // namespace

// Unpacks the input, and chooses a model in it.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::span<const std::uint8_t> bytes(data, size);
  if (size > 1 << 12 || !vitrine::is_package(bytes)) return 0;
  vitrine::fuzz::bounded(kHeap, size, [&] {
    check_unpacked(bytes);
    check_model(bytes);
  });
  return 0;
}
