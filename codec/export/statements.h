// SPDX-License-Identifier: Apache-2.0
// The statements about its content that a file makes in comments or metadata.
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
  std::string text;  // as one_line() returns it
};

// Returns the statements of a file: unit, up, title, creator, rights, licence, source, level and
// error, each if it is known. An unknown unit is stated as "unknown". `options.unit` and
// `options.about.error` must be those of the file.
std::vector<Statement> statements_of(const ExportOptions& options);

// Returns the text as one line of at most 400 bytes of UTF-8, cut between characters. Control
// characters, separators of lines, U+FFFE and U+FFFF become blanks. The line has no blanks at its
// ends, and no backslash at its end, which would continue the line in an OBJ file.
std::string one_line(std::string_view text);

// Writes a line for each statement: the prefix, the name, a blank and the text.
void put_comments(FileWriter& out, std::string_view prefix, std::span<const Statement> statements);

}  // namespace vitrine::inline codec
