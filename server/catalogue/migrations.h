// SPDX-License-Identifier: Apache-2.0
// The tables of a catalogue, and how an older one gets them.
#pragma once

#include <filesystem>
#include <string>

#include "codec/core/expected.h"
#include "server/catalogue/sqlite.h"

namespace vitrine::sqlite {

// Creates or migrates the database. Fails with kIo where the file is refused, kUnsupported where a
// newer version of the software wrote it. The folder must exist.
Expected<Database> open_database(const std::filesystem::path& file);

// kIo, or kLimit where the disk is full: what was refused, why, and what to do.
Unexpected refused(const std::string& what, const Failure& failure);

}  // namespace vitrine::sqlite
