// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

namespace vitrine {

extern const std::string_view kPageStyle;  // the page's CSS, without < and &

}  // namespace vitrine
