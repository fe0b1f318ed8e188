// SPDX-License-Identifier: Apache-2.0
// A model with all that records and citations state about it.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "server/catalogue/catalogue.h"

namespace vitrine::server {

// The size of a mesh: x, y (upwards) and z, in `unit`.
struct Dimensions {
  double width = 0, height = 0, depth = 0;
  std::string unit;
};

// Returns the dimensions as text, such as "12.5 × 31 × 9.25 mm (W × H × D)".
std::string to_text(const Dimensions& size);

// Returns the values of a text that separates them by semicolons, without spaces around them and
// without repetitions. Returns at most kMostValues of them, because a record has several elements
// for each value.
std::vector<std::string> values_in(std::string_view text);
inline constexpr std::size_t kMostValues = 100;

// An object of this class refers to `record`, which must outlive it.
class DescribedModel {
 public:
  // `origin` is the start of absolute URLs, such as "https://museum.example"; may be empty. `size`
  // is nullopt if it is unknown.
  DescribedModel(const ModelRecord& record, std::string origin,
                 std::optional<Dimensions> size = std::nullopt);

  const ModelRecord& record() const { return *record_; }
  const std::optional<Dimensions>& size() const { return size_; }

  // Returns `title`, `creator`, `rights`, `licence` or a text of ModelRecord::more; empty if there
  // is no such text.
  const std::string& text(std::string_view name) const;
  // Returns the title, or the ID if the model has no title.
  std::string title() const;
  // Returns the institution that publishes the model: `publisher`, or the host of this server.
  std::string provider() const;
  // Returns the DOI as a URL, such as https://doi.org/10.5281/zenodo.1234, or an empty text if the
  // model has no DOI.
  std::string doi_url() const;
  // Returns the URI of the licence or, if there is none, of the rights statement (rights_url()).
  // Returns an empty text if neither has a URI.
  std::string rights_uri() const;

  std::string page_url() const;
  // Returns the URL that is expected to stay valid: that of the DOI, else the persistent identifier
  // if it is a web address, else that of the page.
  std::string permanent_url() const;
  std::string glb_url() const;
  std::string poster_url() const;
  std::string card_poster_url() const;  // the poster of default width, as in `links` of a record

 private:
  std::string api_url(std::string_view file) const;

  const ModelRecord* record_;
  std::string origin_;
  std::optional<Dimensions> size_;
};

// Returns the host of an origin, such as "museum.example", without a port. Returns "localhost" if
// `origin` is empty.
std::string host_of(std::string_view origin);

}  // namespace vitrine::server
