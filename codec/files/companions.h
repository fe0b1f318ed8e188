// SPDX-License-Identifier: Apache-2.0
// Companions are the files to which a mesh file refers by name, such as material libraries and
// pictures.
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <string_view>

#include "codec/core/expected.h"

namespace vitrine::inline codec {

// Contents of the companion files. The key is the companion_key() of the file's path, which is
// relative to the folder of the mesh file.
using Companions = std::map<std::string, std::span<const std::uint8_t>, std::less<>>;

// Returns the text as UTF-8. Text that is not valid UTF-8 is treated as windows-1252, because older
// programs write names in this encoding.
std::string as_utf8(std::string_view text);

// Returns the last part of a path, in lower case and as UTF-8. Both slashes and backslashes
// separate parts, because mesh files contain paths from other machines.
std::string name_key(std::string_view path);

// Returns the parts of a path in reverse order, in lower case and as UTF-8, so that files with the
// same name are neighbours in Companions. For "./Maps/Skin.png" the result is "skin.png/maps".
std::string companion_key(std::string_view path);

// Returns the path of a key, in lower case.
std::string companion_path(std::string_view key);

// Lets files share their bytes if they are neighbours in `companions` and have equal contents.
// find_companion() may then return any of these copies. Comparing contents in each search instead
// could take very long.
void share_equal_contents(Companions& companions);

// Decodes the percent-encoded bytes of a URI ([RFC3986] section 2.1), such as "%20" for a space.
// Leaves a percent sign as it is if two hexadecimal digits do not follow it.
std::string percent_decoded(std::string_view uri);

// The kinds of companions, by the extensions of their names. kPicture includes formats that cannot
// be read, so that an error message can name the format.
enum class CompanionKind : std::uint8_t { kOther, kLibrary, kBuffer, kPicture };
CompanionKind companion_kind(std::string_view name);

// A path as stated in a file, and the folder of that file, relative to the folder of the mesh file.
struct StatedPath {
  std::string_view path;
  std::string_view folder = {};
};

// Finds the companion to which a path refers. The first rule that leaves exactly one file decides:
// 1. the file at this path, relative to the folder of the file that states the path
// 2. the file at this path, relative to the folder of the mesh file
// 3. the files with the same name whose paths end most like the stated path
// 4. of these files, those in the folder of the mesh file, or else those below that folder
// 5. of these files, those with the fewest folders in their paths
//
// Fails (kBadInput) if there is no such file, if rule 5 leaves several files that do not share
// their bytes, or if over 256 files have the same name. The error message has no subject, so that
// the caller can put the stated path before it.
Expected<const Companions::value_type*> find_companion(const Companions& companions,
                                                       const StatedPath& stated);

}  // namespace vitrine::inline codec
