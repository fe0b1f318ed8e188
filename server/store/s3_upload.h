// SPDX-License-Identifier: Apache-2.0
// Uploads objects to an S3-compatible store.
#pragma once

#include "server/store/s3_client.h"

namespace vitrine::server {

// Stores an object completely or not at all. Uses a multipart upload if it is longer than
// `part_bytes`. Fails with kIo.
Expected<void> s3_upload(S3Client& client, const std::string& key,
                         std::span<const std::uint8_t> bytes, std::uint64_t part_bytes);

// Aborts a multipart upload. Succeeds if the upload does not exist. Fails with kIo.
Expected<void> s3_give_up(S3Client& client, const std::string& key, const std::string& upload);

}  // namespace vitrine::server
