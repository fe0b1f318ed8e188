// SPDX-License-Identifier: Apache-2.0
// The style sheet of the report page.
#pragma once

#include <string_view>

namespace vitrine::server {

extern const std::string_view kPageStyle;  // the page's CSS, without < and &

}  // namespace vitrine::server
