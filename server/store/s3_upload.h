// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/store/s3_client.h"

namespace vitrine {

// Puts the object, in parts of `part_bytes` where it is longer: it is there as a whole or not at
// all. Fails with kIo.
Expected<void> s3_upload(S3Client& client, const std::string& key,
                         std::span<const std::uint8_t> bytes, std::uint64_t part_bytes);

// Gives up an upload in parts; that there is none is no fault. Fails with kIo.
Expected<void> s3_give_up(S3Client& client, const std::string& key, const std::string& upload);

}  // namespace vitrine
