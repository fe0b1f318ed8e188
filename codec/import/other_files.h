// SPDX-License-Identifier: Apache-2.0
// Describes files that no reader can read: the kind of the file, from its bytes or the extension of
// its name, and how to convert it.
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
// compound format. Uses the extension of `name` if the bytes do not determine the kind.
std::optional<OtherFile> describe_other_file(std::span<const std::uint8_t> bytes,
                                             std::string_view name = {});

}  // namespace vitrine::inline codec
