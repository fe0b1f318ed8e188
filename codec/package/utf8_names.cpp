// SPDX-License-Identifier: Apache-2.0
#include "codec/package/utf8_names.h"

namespace vitrine::inline codec {
namespace {

// Loaded when the program starts, because a sandboxed process may not open the locale's files. Null
// if the system does not have the locale.
const locale_t kUtf8Locale = ::newlocale(LC_CTYPE_MASK, "C.UTF-8", nullptr);

}  // namespace

Utf8Names::Utf8Names() : before_(::uselocale(kUtf8Locale)) {}

Utf8Names::~Utf8Names() {
  ::uselocale(before_);
}

}  // namespace vitrine::inline codec
