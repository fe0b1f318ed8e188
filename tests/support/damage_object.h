// SPDX-License-Identifier: Apache-2.0
// Damages a stored object, as a failing disk does.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "codec/core/sha256.h"
#include "support/product_names.h"

namespace vitrine::test {

// Changes the last byte of an object in the data folder `data`.
inline void damage_object(const std::filesystem::path& data, const Sha256& object) {
  const std::string name = to_hex(object);
  std::fstream file(data / "objects" / name.substr(0, 2) / name.substr(2, 2) / name,
                    std::ios::in | std::ios::out | std::ios::binary);
  file.seekg(-1, std::ios::end);
  const int last = file.get();
  file.seekp(-1, std::ios::end).put(static_cast<char>(last ^ 1));
  EXPECT_TRUE(file.flush());
}

}  // namespace vitrine::test
