// SPDX-License-Identifier: Apache-2.0
// The result type of everything that can fail on data: a value, or an error that a person can act
// on.
#pragma once

#include <string>
#include <tl/expected.hpp>
#include <utility>

namespace vitrine {

enum class ErrorCode {
  kBadInput,     // the bytes are not what they claim to be
  kUnsupported,  // well-formed, but needs a feature this build does not have
  kLimit,        // a count exceeds the stated limits
  kState,        // the call is not possible in the present state (a chunk out of order)
  kIo,           // the operating system refused
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

}  // namespace vitrine
