// SPDX-License-Identifier: Apache-2.0
// Answers requests of OAI-PMH 2.0 [OAI-PMH], by which other catalogues harvest the records of all
// published models. Collections are its sets. Withdrawn and removed models disappear without a
// trace (deletedRecord "no"): the catalogue does not store when a model was removed, and must not
// reveal that a draft exists.
#pragma once

#include <cstdint>
#include <string>

#include "codec/core/expected.h"
#include "server/catalogue/catalogue.h"
#include "server/messages/query.h"

namespace vitrine::server {

// The facts that a response states about the server.
struct OaiSite {
  std::string origin;   // start of absolute URLs, such as "https://museum.example"
  std::string contact;  // e-mail address; empty: webmaster@ and the host ([RFC2142])
  // Seconds since 1970, UTC. Lists state the time of the catalogue's clock instead.
  std::int64_t now = 0;
};

// Returns the response as an XML document. A list ends after kOaiPage records, or after the record
// with which it exceeds kOaiPageBytes. Errors of OAI-PMH are responses, too. Fails with kIo if the
// catalogue cannot be read.
Expected<std::string> answer_oai(const Query& arguments, const OaiSite& site, Catalogue& catalogue);

inline constexpr std::uint32_t kOaiPage = 100;
inline constexpr std::size_t kOaiPageBytes = 1 << 20;

}  // namespace vitrine::server
