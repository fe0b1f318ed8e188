// SPDX-License-Identifier: Apache-2.0
// What models and uploads together may take of the disk.
#pragma once

#include "server/catalogue/catalogue.h"
#include "server/store/uploads.h"

namespace vitrine {

class Quota {
 public:
  // `bytes`: 0: as much as there is.
  Quota(Catalogue& catalogue, const Uploads& uploads, std::uint64_t bytes)
      : catalogue_(catalogue), uploads_(uploads), bytes_(bytes) {}

  // Whether `more` bytes fit beside what models name and uploads have announced. kLimit where not,
  // kIo where the catalogue or the disk refuses.
  Expected<void> admit(std::uint64_t more) const;

 private:
  Catalogue& catalogue_;
  const Uploads& uploads_;
  const std::uint64_t bytes_;
};

}  // namespace vitrine
