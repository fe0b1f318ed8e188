// SPDX-License-Identifier: Apache-2.0
// Makes libarchive return names as UTF-8.
#pragma once

#include <clocale>

namespace vitrine::inline codec {

// While an object of this class exists, the calling thread uses the locale C.UTF-8. In the locale
// C, libarchive returns no names with non-ASCII characters.
class Utf8Names {
 public:
  Utf8Names();
  ~Utf8Names();
  Utf8Names(const Utf8Names&) = delete;
  Utf8Names& operator=(const Utf8Names&) = delete;

 private:
  locale_t before_;
};

}  // namespace vitrine::inline codec
