// SPDX-License-Identifier: Apache-2.0
// Names files that are not read by what they are, according to their bytes and the extensions of
// their names, and says how to convert them.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace vitrine::inline codec {

struct OtherFile {
  // The kind of the file and the next step, such as "this is a PDF document: export the model
  // itself, as GLB".
  std::string text;
  bool is_model;  // false for pictures, documents and other files that accompany models
};

// Returns the kind of a file, or nullopt if it is unknown. Call this for files that no reader
// recognises. The first 4 KB of a file suffice, except for packages and files of Microsoft's
// compound format. The extension of `name` counts if the bytes do not tell the kind.
std::optional<OtherFile> describe_other_file(std::span<const std::uint8_t> bytes,
                                             std::string_view name = {});

}  // namespace vitrine::inline codec
