// SPDX-License-Identifier: Apache-2.0
#include "server/records/described_model.h"

#include <fmt/format.h>

#include <algorithm>

#include "server/metadata/rights.h"
#include "server/records/links.h"

namespace vitrine::server {
namespace {

std::string_view without_spaces(std::string_view text) {
  const std::size_t first = std::min(text.find_first_not_of(' '), text.size());
  const std::size_t last = text.find_last_not_of(' ');
  return first == text.size() ? std::string_view() : text.substr(first, last + 1 - first);
}

}  // namespace

std::string to_text(const Dimensions& size) {
  return fmt::format("{} × {} × {} {} (W × H × D)", size.width, size.height, size.depth, size.unit);
}

std::vector<std::string> values_in(std::string_view text) {
  std::vector<std::string> values;
  while (!text.empty() && values.size() < kMostValues) {
    const std::string_view part = text.substr(0, text.find(';'));
    text.remove_prefix(std::min(text.size(), part.size() + 1));
    const auto value = without_spaces(part);
    if (!value.empty() && std::ranges::find(values, value) == values.end())
      values.emplace_back(value);
  }
  return values;
}

DescribedModel::DescribedModel(const ModelRecord& record, std::string origin,
                               std::optional<Dimensions> size)
    : record_(&record), origin_(std::move(origin)), size_(std::move(size)) {}

const std::string& DescribedModel::text(std::string_view name) const {
  static const std::string kNone;
  if (name == "title") return record_->title;
  if (name == "creator") return record_->creator;
  if (name == "rights") return record_->rights;
  if (name == "licence") return record_->licence;
  const auto found = record_->more.find(std::string(name));
  return found == record_->more.end() ? kNone : found->second;
}

std::string DescribedModel::title() const {
  return record_->title.empty() ? record_->id.to_string() : record_->title;
}

std::string DescribedModel::provider() const {
  const std::string& publisher = text("publisher");
  return publisher.empty() ? host_of(origin_) : publisher;
}

std::string DescribedModel::doi_url() const {
  const std::string& doi = text("doi");
  if (doi.empty()) return doi;
  const std::size_t slash = doi.find('/');
  return fmt::format("https://doi.org/{}/{}", doi.substr(0, slash),
                     escape_query(doi.substr(std::min(slash, doi.size() - 1) + 1)));
}

std::string DescribedModel::rights_uri() const {
  if (auto uri = rights_url(record_->licence)) return *uri;
  return rights_url(text("rights_statement")).value_or("");
}

std::string DescribedModel::page_url() const {
  return origin_ + "/models/" + record_->id.to_string();
}

std::string DescribedModel::permanent_url() const {
  if (const std::string url = doi_url(); !url.empty()) return url;
  const std::string& id = text("persistent_identifier");
  return id.starts_with("https://") || id.starts_with("http://") ? id : page_url();
}

std::string DescribedModel::glb_url() const {
  return api_url("export.glb");
}

std::string DescribedModel::poster_url() const {
  return api_url(fmt::format("poster.png?width={}", kCanvasWidth));
}

std::string DescribedModel::card_poster_url() const {
  return api_url("poster.png");
}

std::string DescribedModel::api_url(std::string_view file) const {
  return fmt::format("{}/api/v1/models/{}/{}", origin_, record_->id.to_string(), file);
}

std::string host_of(std::string_view origin) {
  if (const auto scheme = origin.find("://"); scheme != origin.npos)
    origin.remove_prefix(scheme + 3);
  origin = origin.substr(0, origin.find('/'));
  const auto port = origin.rfind(':');
  // The address [::1] has colons, too.
  if (port != origin.npos && origin.find(']', port) == origin.npos) origin = origin.substr(0, port);
  return origin.empty() ? "localhost" : std::string(origin);
}

}  // namespace vitrine::server
