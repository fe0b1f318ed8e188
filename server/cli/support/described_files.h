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

// Returns the operands IN, or the files of the sheet in a folder IN, with their texts: from the row
// of the sheet if there is a sheet, otherwise from the flags. The title is otherwise the file's
// name. Checks all texts. Prints a note that names the rows without a file. Fails if a file has no
// row.
tl::expected<std::vector<DescribedFile>, Fault> described_files(const Arguments& arguments);

}  // namespace vitrine::server::cli
