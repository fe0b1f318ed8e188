// SPDX-License-Identifier: Apache-2.0
#include "server/records/oai.h"

#include <fmt/format.h>

#include <algorithm>

#include "server/messages/timestamp.h"
#include "server/records/oai_request.h"
#include "server/records/oai_set.h"
#include "server/records/xml.h"

namespace vitrine::server {
namespace {

constexpr const char* kOaiNamespace = "http://www.openarchives.org/OAI/2.0/";
constexpr const char* kOaiSchema = "http://www.openarchives.org/OAI/2.0/OAI-PMH.xsd";

// The result of a verb: nullopt if the response was written into the document, or the fault of the
// request. An error means that the catalogue cannot be read.
using OaiResult = Expected<std::optional<OaiFault>>;

OaiFault no_such_id() {
  return {"idDoesNotExist", "there is no published model with this identifier"};
}

// Number of seconds by which the responseDate lies before the time at which the rows were read. The
// catalogue stamps a change with the time of its last SQL statement, but shows it only after its
// commit, a moment later. A harvester asks for changes since the responseDate of its last list.
// Thanks to the margin, it gets some records twice, but misses none.
constexpr std::int64_t kSecondsToCommit = 5;

std::string mail_of(const OaiSite& site) {
  if (!site.contact.empty()) return site.contact;
  const std::string host = host_of(site.origin);
  // The schema requires a host with a dot.
  return "webmaster@" + host + (host.find('.') == host.npos ? ".invalid" : "");
}

// Writes the response to one request into a document.
class OaiAnswer {
 public:
  OaiAnswer(pugi::xml_node root, const OaiRequest& request, const OaiSite& site,
            Catalogue& catalogue)
      : root_(root), request_(request), site_(site), catalogue_(catalogue), date_(site.now) {}

  OaiResult write() {
    switch (request_.verb) {
      case OaiVerb::kIdentify:
        return identify();
      case OaiVerb::kListMetadataFormats:
        return list_formats();
      case OaiVerb::kListSets:
        return list_sets();
      case OaiVerb::kGetRecord:
        return get_record();
      case OaiVerb::kListIdentifiers:
        return list("ListIdentifiers");
      case OaiVerb::kListRecords:
        return list("ListRecords");
    }
    return std::nullopt;
  }

  // Returns the responseDate. Call after write().
  std::int64_t date() const { return date_; }

 private:
  Expected<Harvest> harvest(const HarvestQuery& query) {
    auto found = catalogue_.harvest(query);
    if (found) date_ = found->now - kSecondsToCommit;
    return found;
  }

  OaiResult identify() {
    const auto first = harvest({.limit = 1});
    if (!first) return tl::unexpected(first.error());
    const std::string host = host_of(site_.origin);
    pugi::xml_node node = root_.append_child("Identify");
    add_text(node, "repositoryName", "3D models at " + host);
    add_text(node, "baseURL", site_.origin + "/api/v1/oai");
    add_text(node, "protocolVersion", "2.0");
    add_text(node, "adminEmail", mail_of(site_));
    add_text(node, "earliestDatestamp",
             utc_time(first->models.empty() ? 0 : first->models[0].changed));
    add_text(node, "deletedRecord", "no");
    add_text(node, "granularity", "YYYY-MM-DDThh:mm:ssZ");
    return std::nullopt;
  }

  OaiResult list_formats() {
    if (request_.identifier) {
      const auto found = find();
      if (!found) return tl::unexpected(found.error());
      if (!*found) return no_such_id();
    }
    pugi::xml_node list = root_.append_child("ListMetadataFormats");
    for (const RecordFormat* format : kRecordFormats) {
      pugi::xml_node node = list.append_child("metadataFormat");
      add_text(node, "metadataPrefix", format->prefix);
      add_text(node, "schema", format->schema);
      add_text(node, "metadataNamespace", format->xml_namespace);
    }
    return std::nullopt;
  }

  OaiResult list_sets() {
    const auto names = catalogue_.collections();
    if (!names) return tl::unexpected(names.error());
    if (names->empty()) return OaiFault{"noSetHierarchy", "no model belongs to a collection"};
    const auto first = std::ranges::upper_bound(*names, request_.after_collection);
    if (first == names->end())
      return OaiFault{"badResumptionToken", "no set is left; begin the list again"};
    const auto left = names->end() - first;
    const auto last = first + std::min<std::ptrdiff_t>(left, kOaiPage);
    pugi::xml_node list = root_.append_child("ListSets");
    for (auto name = first; name != last; ++name) {
      pugi::xml_node node = list.append_child("set");
      add_text(node, "setSpec", set_spec(*name));
      add_text(node, "setName", *name);
    }
    add_token(list, last == names->end() ? "" : token_after_set(*(last - 1)),
              static_cast<std::uint64_t>(first - names->begin()), names->size());
    return std::nullopt;
  }

  OaiResult get_record() {
    const auto found = find();
    if (!found) return tl::unexpected(found.error());
    if (!*found) return no_such_id();
    add_record_of(root_.append_child("GetRecord"), **found);
    return std::nullopt;
  }

  OaiResult list(const char* verb) {
    const auto found = harvest({.from = request_.from,
                                .until = request_.until,
                                .collection = request_.collection,
                                .after = request_.after,
                                .limit = kOaiPage + 1});
    if (!found) return tl::unexpected(found.error());
    if (found->models.empty()) {
      if (request_.after)
        return OaiFault{"badResumptionToken", "no record is left; begin the list again"};
      return OaiFault{"noRecordsMatch", "no published model matches the arguments"};
    }
    pugi::xml_node list = root_.append_child(verb);
    const std::size_t count = add_page(list, found->models);
    const std::uint64_t all = request_.after ? request_.all : found->all;
    std::string token;
    if (count < found->models.size()) token = token_after(found->models[count - 1], count, all);
    add_token(list, token, request_.cursor, std::max<std::uint64_t>(all, request_.cursor + count));
    return std::nullopt;
  }

  // Appends the records, or their headers, of one page. Returns their number, 1 or more.
  std::size_t add_page(pugi::xml_node list, const std::vector<HarvestedModel>& models) {
    std::size_t count = 0, bytes = 0;
    while (count < std::min<std::size_t>(models.size(), kOaiPage) && bytes < kOaiPageBytes) {
      const HarvestedModel& found = models[count++];
      if (request_.verb == OaiVerb::kListRecords)
        add_record_of(list, found);
      else
        add_header(list, found);
      bytes += bytes_of(list.last_child());
    }
    return count;
  }

  std::string token_after(const HarvestedModel& last, std::size_t count, std::uint64_t all) const {
    return to_text(ResumptionToken{.format = request_.format,
                                   .from = request_.from,
                                   .until = request_.until,
                                   .collection = request_.collection,
                                   .after = {.changed = last.changed, .model = last.model.id},
                                   .cursor = request_.cursor + static_cast<std::uint32_t>(count),
                                   .all = static_cast<std::uint32_t>(all)});
  }

  // Appends the token for the next page. The last of several pages has an empty token.
  static void add_token(pugi::xml_node list, const std::string& text, std::uint64_t cursor,
                        std::uint64_t all) {
    if (text.empty() && cursor == 0) return;
    pugi::xml_node node = add_element(list, "resumptionToken", text);
    add_attribute(node, "completeListSize", std::to_string(all));
    add_attribute(node, "cursor", std::to_string(cursor));
  }

  std::string id_prefix() const { return fmt::format("oai:{}:", host_of(site_.origin)); }

  // Returns the published model that `identifier` names.
  Expected<std::optional<HarvestedModel>> find() {
    std::string_view id = *request_.identifier;
    const std::string prefix = id_prefix();
    if (!id.starts_with(prefix)) return std::nullopt;
    id.remove_prefix(prefix.size());
    const auto model = ModelId::parse(id);
    if (!model) return std::nullopt;
    auto found = harvest({.model = model, .limit = 1});
    if (!found) return tl::unexpected(found.error());
    if (found->models.empty()) return std::nullopt;
    return std::move(found->models[0]);
  }

  void add_header(pugi::xml_node parent, const HarvestedModel& found) const {
    pugi::xml_node header = parent.append_child("header");
    add_text(header, "identifier", id_prefix() + found.model.id.to_string());
    add_text(header, "datestamp", utc_time(found.changed));
    const DescribedModel model(found.model, site_.origin);
    for (const std::string& collection : values_in(model.text("collection")))
      add_text(header, "setSpec", set_spec(collection));
  }

  void add_record_of(pugi::xml_node parent, const HarvestedModel& found) const {
    pugi::xml_node record = parent.append_child("record");
    add_header(record, found);
    add_record(record.append_child("metadata"), *request_.format, {found.model, site_.origin});
  }

  pugi::xml_node root_;
  const OaiRequest& request_;
  const OaiSite& site_;
  Catalogue& catalogue_;
  std::int64_t date_;
};

// Appends the element `request`, with the arguments if `has_arguments`. OAI-PMH omits them after
// the faults badVerb and badArgument.
void add_request(pugi::xml_node root, const Query& arguments, bool has_arguments,
                 const OaiSite& site) {
  pugi::xml_node node = add_element(root, "request", site.origin + "/api/v1/oai");
  if (!has_arguments) return;
  for (const char* name : kOaiArguments)
    if (const auto value = arguments.get(name)) add_attribute(node, name, *value);
}

}  // namespace

Expected<std::string> answer_oai(const Query& arguments, const OaiSite& site,
                                 Catalogue& catalogue) {
  const auto request = read_oai_request(arguments);
  const std::string_view code = request ? "" : request.error().code;
  pugi::xml_document document;
  pugi::xml_node root = document.append_child("OAI-PMH");
  add_namespace(root, "xmlns", kOaiNamespace);
  add_schema_location(root, kOaiNamespace, kOaiSchema);
  pugi::xml_node date = add_element(root, "responseDate", utc_time(site.now));
  add_request(root, arguments, code != "badVerb" && code != "badArgument", site);
  std::optional<OaiFault> fault;
  if (request) {
    OaiAnswer answer(root, *request, site, catalogue);
    auto result = answer.write();
    if (!result) return tl::unexpected(result.error());
    fault = *result;
    date.text().set(utc_time(answer.date()).c_str());
  } else {
    fault = request.error();
  }
  if (fault) add_attribute(add_element(root, "error", fault->message), "code", fault->code);
  return to_text(document);
}

}  // namespace vitrine::server
