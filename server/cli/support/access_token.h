// SPDX-License-Identifier: Apache-2.0
// The access token with which a command calls a server.
#pragma once

#include <string>

#include "server/cli/support/arguments.h"

namespace vitrine::server::cli {

inline constexpr Flag kTokenFileFlag = {
    "--token-file", "FILE",
    "file that contains the token, so that the list of processes does not show it (default: the "
    "environment variable VITRINE_TOKEN)"};

// Whether the command line names a token, in a flag or a file.
bool names_token(const Arguments& arguments);

// Returns the token of --token, else of --token-file, else of the environment variable
// VITRINE_TOKEN, else an empty text. The command must declare both flags. A usage error if both are
// given, or if the token is not one word of printable ASCII. A failure if the file cannot be read.
tl::expected<std::string, Fault> access_token(const Arguments& arguments);

}  // namespace vitrine::server::cli
