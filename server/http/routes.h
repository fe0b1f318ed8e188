// SPDX-License-Identifier: Apache-2.0
// The tables of routes: what visitors reach, and what only the operator's machine reaches.
#pragma once

#include <span>

#include "server/http/router.h"

namespace vitrine {

std::span<const Route> public_routes();
std::span<const Route> admin_routes();

}  // namespace vitrine
