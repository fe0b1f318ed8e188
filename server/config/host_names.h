// SPDX-License-Identifier: Apache-2.0
// Decides by the Host field whether to answer a request. This prevents DNS rebinding, where a page
// of another site makes its own host name resolve to the daemon's address. Requests from that page
// then have the page's host name in their Host field, so they are refused.
#pragma once

#include <string_view>

#include "server/config/settings.h"

namespace vitrine::server {

// Whether `host`, the value of a Host field with or without a port, names this daemon: the host of
// public-url or scan-address, an entry of the setting hosts, localhost, or a numeric address, which
// DNS rebinding cannot use. Also true for an empty value, because browsers never send an empty Host
// field.
bool is_own_host(const Settings& settings, std::string_view host);

// Whether the daemon answers requests for `host` on the address `listen`. If neither public-url nor
// hosts is set, it answers requests for every host, otherwise only for its own hosts.
bool is_public_host(const Settings& settings, std::string_view host);

// Whether `origin`, the value of an Origin field, is an entry of the setting allowed-origins.
bool is_trusted_origin(const Settings& settings, std::string_view origin);

// Whether `text` is an origin in the form that browsers send: scheme, host in lower case, and the
// port unless it is the default.
bool is_origin(std::string_view text);

// Whether `text` is a host name without a port.
bool is_host_name(std::string_view text);

}  // namespace vitrine::server
