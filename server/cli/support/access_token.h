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

// Whether the command line states a token, with the flag --token or --token-file.
bool names_token(const Arguments& arguments);

// Returns the token from --token, from the file of --token-file, or else from the environment
// variable VITRINE_TOKEN. Returns an empty text if there is none. The command must declare both
// flags. Returns a usage error if both flags are given, or if the token is not one word of
// printable ASCII. Returns a failure if the file cannot be read.
tl::expected<std::string, Fault> access_token(const Arguments& arguments);

}  // namespace vitrine::server::cli
