// SPDX-License-Identifier: Apache-2.0
// Fetches the pictures and the originals of a texture over HTTP.
#pragma once

#include <span>

#include "server/cli/client/stream_client.h"

namespace vitrine::server {

// Fetches the texture's pictures with the given numbers, except those that `model` already
// contains. Returns the number of bytes received. Fails with kIo if the server cannot be reached or
// files cannot be written, with kState if the server does not have a picture, and with kBadInput if
// a picture has the wrong hash. After a failure, `model` keeps the pictures that have arrived, so
// that the next run need not fetch them.
Expected<std::uint64_t> fetch_pictures(const FetchOptions& options,
                                       std::span<const std::size_t> pictures, PartialModel& model);

// Fetches the optional blocks of `model`, such as the source's pictures, except those that `model`
// already contains. Returns and fails like fetch_pictures().
Expected<std::uint64_t> fetch_optional_blocks(const FetchOptions& options, PartialModel& model);

}  // namespace vitrine::server
