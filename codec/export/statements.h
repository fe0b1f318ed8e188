// SPDX-License-Identifier: Apache-2.0
// The comments or metadata in which a mesh file describes its content, such as unit, title and
// licence.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "codec/export/export_options.h"
#include "codec/export/file_writer.h"

namespace vitrine::inline codec {

struct Statement {
  std::string_view name;
  std::string text;  // in the form that one_line() returns
};

// Returns the statements of a file, in this order: unit, up, title, creator, rights, licence,
// source, level and error. Omits values that are not known, but states an unknown unit as
// "unknown". `options.unit` must be the unit of the file, and `options.about.error` must be in this
// unit.
std::vector<Statement> statements_of(const ExportOptions& options);

// Returns the text as one line of at most 400 bytes of UTF-8. Does not cut within a character.
// Control characters, line separators, U+FFFE and U+FFFF become spaces. The line neither starts nor
// ends with a space. It does not end with a backslash, which would continue the line in an OBJ
// file.
std::string one_line(std::string_view text);

// Writes one line for each statement: `prefix`, the statement's name, a space and its text.
void put_comments(FileWriter& out, std::string_view prefix, std::span<const Statement> statements);

}  // namespace vitrine::inline codec
