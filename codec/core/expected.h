// SPDX-License-Identifier: Apache-2.0
// The result type of functions that can fail: a value or an error. The message of an error tells
// the user what to do next.
#pragma once

#include <string>
#include <tl/expected.hpp>
#include <utility>

namespace vitrine::inline codec {

enum class ErrorCode {
  kBadInput,     // the input is malformed or inconsistent
  kUnsupported,  // the input is valid but needs an unsupported feature
  kLimit,        // a count or size exceeds its limit
  // The call is not allowed in the current state; for example, a chunk is applied out of order.
  kState,
  kIo,  // an error of the operating system, a device or the network
};

struct Error {
  ErrorCode code;
  std::string message;  // one line: the fault, its place, the next step
};

template <class T>
using Expected = tl::expected<T, Error>;

using Unexpected = tl::unexpected<Error>;

inline Unexpected fail(ErrorCode code, std::string message) {
  return Unexpected(Error{code, std::move(message)});
}

}  // namespace vitrine::inline codec
