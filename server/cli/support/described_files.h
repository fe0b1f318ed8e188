// SPDX-License-Identifier: Apache-2.0
// The files that `vitrine publish` is to publish, each with the texts that describe it.
#pragma once

#include <vector>

#include "codec/import/read_mesh.h"
#include "server/cli/support/arguments.h"
#include "server/cli/support/companion_files.h"
#include "server/store/publish.h"

namespace vitrine::server::cli {

inline constexpr Flag kSheetFlag = {
    "--metadata", "SHEET.csv",
    "texts for each file: a spreadsheet saved as CSV UTF-8. Its first line names the columns: "
    "file, "
    "and any of title, creator, rights, licence, the other texts of the REST interface, unit and "
    "up. "
    "A text overrides the flag of the same name. If IN is a folder that the sheet does not name, "
    "publishes the files of all rows from it"};

struct DescribedFile {
  ModelPath model;
  ModelMetadata about;
  ReadOptions reading;
  bool states_reading = false;  // whether a flag or the sheet gives the unit or the upward axis
};

// Returns the files that the operands IN name, with their texts. If IN is a folder that no row of
// the sheet names, returns the files of all rows, which are in that folder. The texts come from the
// file's row of the sheet, and otherwise from the flags. The default title is the file's name.
// Checks all texts. Prints a note about the rows that no file uses. Fails if there is a sheet
// without a row for a file.
tl::expected<std::vector<DescribedFile>, Fault> described_files(const Arguments& arguments);

}  // namespace vitrine::server::cli
