// SPDX-License-Identifier: Apache-2.0
// Serves and changes the notes on a model's surface and the tours through them. A client that may
// see a model may see its notes. Also serves the notes as IIIF annotations, to which the model's
// IIIF manifests refer.
#include "server/metadata/notes.h"

#include <nlohmann/json.hpp>

#include "codec/mesh/unit.h"
#include "server/api/handlers.h"
#include "server/api/published.h"
#include "server/messages/conditional.h"

namespace vitrine::server {
namespace {

using OrderedJson = nlohmann::ordered_json;

// A kind of document about a model: its notes or its tours. `name` is the member with the list of
// notes or tours in requests and responses, and `check` finds the faults of this list.
struct NoteDocument {
  NoteKind kind;
  const char* name;
  void (*check)(const nlohmann::json& list, const WrongField& wrong);
};

constexpr NoteDocument kNotesDocument{NoteKind::kNotes, "notes", check_notes};
constexpr NoteDocument kToursDocument{NoteKind::kTours, "tours", check_tours};

std::string document_json(const NoteDocument& document, const NoteSheet& sheet) {
  return fmt::format(R"({{"{}":{}}})", document.name, sheet.text.empty() ? "[]" : sheet.text);
}

Response show_document(const NoteDocument& document, const Request& request, Services& services) {
  return with_model(request, services, [&](const auto& model) {
    const auto sheet = services.notes.find(model->record().id, document.kind);
    if (!sheet) return internal_error(sheet.error(), request, services);
    return revalidated("application/json", document_json(document, *sheet));
  });
}

// Returns the faults of a request's body, but at most kMost of them.
FieldFaults faults_of(const NoteDocument& document, const nlohmann::json& body) {
  constexpr std::size_t kMost = 100;  // bounds the response to a large body with many faults
  FieldFaults faults;
  const auto add = [&](const std::string& field, const std::string& expected) {
    if (faults.size() < kMost) faults.push_back({field, expected});
  };
  for (const auto& [name, value] : body.items()) {
    if (name != document.name) add(name, fmt::format("only {}", document.name));
  }
  const auto list = body.find(document.name);
  if (list == body.end()) {
    add(document.name, "a list");
    return faults;
  }
  document.check(*list, [&](const std::string& field, const std::string& expected) {
    add(document.name + (field.empty() ? "" : '.' + field), expected);
  });
  return faults;
}

Response notes_have_changed(const Request& request) {
  return problem(412, "the notes or tours have changed since; read them again", request.id);
}

// Whether the request has an If-Match field that does not match the current document.
bool is_stale(const std::string& present, const Request& request) {
  const auto wanted = request.header.find(beast::http::field::if_match);
  if (wanted == request.header.end()) return false;
  const auto list = wanted->value();
  return !matches_any({list.data(), list.size()}, entity_tag(present));
}

Response no_model(const Request& request) {
  return problem(404, "there is no such model", request.id);
}

// Returns the response to a PUT that stored nothing, because another request has removed the model
// or changed the document meanwhile. Returns nullopt if the document was changed and the PUT has no
// If-Match field. The caller then replaces the changed document.
std::optional<Response> after_conflict(const ModelId& id, const Request& request,
                                       Services& services) {
  const auto model = services.catalogue.find(id);
  if (!model) return internal_error(model.error(), request, services);
  if (!*model) return no_model(request);
  if (request.header.count(beast::http::field::if_match) > 0) return notes_have_changed(request);
  return std::nullopt;
}

Response change_document(const NoteDocument& document, const Request& request, Services& services) {
  const auto model = services.catalogue.find(id_in<ModelId>(request));
  if (!model) return internal_error(model.error(), request, services);
  if (!*model) return no_model(request);
  const ModelId& id = (*model)->id;
  auto before = services.notes.find(id, document.kind);
  if (!before) return internal_error(before.error(), request, services);
  if (is_stale(document_json(document, *before), request)) return notes_have_changed(request);
  if (const auto faults = faults_of(document, request.body); !faults.empty())
    return invalid(faults, request);
  const nlohmann::json& list = request.body.at(document.name);
  NoteSheet sheet{before->version, static_cast<std::uint32_t>(list.size()), list.dump()};
  auto done = services.notes.put(id, document.kind, sheet);
  if (!done && done.error().code == ErrorCode::kState) {
    if (auto response = after_conflict(id, request, services)) return std::move(*response);
    before = services.notes.find(id, document.kind);
    if (!before) return internal_error(before.error(), request, services);
    sheet.version = before->version;
    done = services.notes.put(id, document.kind, sheet);
  }
  if (!done) return refused(done.error(), request, services);
  services.models.refresh();
  return for_caller(revalidated("application/json", document_json(document, sheet)));
}

OrderedJson text_body(const std::string& language, const nlohmann::json& text) {
  return {{"type", "TextualBody"},
          {"language", language},
          {"format", "text/plain"},
          {"value", text.contains("text") ? text.at("text") : text.at("title")}};
}

OrderedJson media_body(std::string url, const std::string& origin, const char* type) {
  if (url.starts_with('/')) url.insert(0, origin);
  return {{"id", std::move(url)}, {"type", type}};
}

// This and the next two functions throw nlohmann::json::exception if the stored note is damaged.
// Returns the bodies of the annotation of a note: its texts, its sounds and its picture.
OrderedJson bodies_of(const nlohmann::json& note, const std::string& origin) {
  OrderedJson all = OrderedJson::array();
  for (const auto& [language, text] : note.at("texts").items()) {
    all.push_back(text_body(language, text));
    if (!text.contains("audio")) continue;
    OrderedJson sound = media_body(text.at("audio"), origin, "Sound");
    sound["language"] = language;
    all.push_back(std::move(sound));
  }
  if (note.contains("picture")) all.push_back(media_body(note.at("picture"), origin, "Image"));
  return all;
}

OrderedJson annotation_of(const nlohmann::json& note, const std::string& self,
                          const std::string& origin, OrderedJson target) {
  OrderedJson label;
  for (const auto& [language, text] : note.at("texts").items())
    label[language] = {text.at("title")};
  return {{"id", fmt::format("{}/annotations/{}", self, note.at("id").get<std::string>())},
          {"type", "Annotation"},
          {"label", std::move(label)},
          {"motivation", OrderedJson::array({"commenting"})},
          {"body", bodies_of(note, origin)},
          {"target", std::move(target)}};
}

// Returns the place of a note in the IIIF scene, which has the coordinates of the model's GLB.
OrderedJson place_in_scene(const nlohmann::json& note, const ModelRecord& record,
                           const std::string& self) {
  const auto& p = note.at("position");
  const double metres = metres_per(record.unit).value_or(1);
  const Vec3 place =
      PresentationTransform(record.presentation)({p.at(0), p.at(1), p.at(2)}) * metres;
  return {{"type", "SpecificResource"},
          {"source", OrderedJson::array({{{"id", self + "/scene"}, {"type", "Scene"}}})},
          {"selector",
           OrderedJson::array(
               {{{"type", "PointSelector"}, {"x", place.x}, {"y", place.y}, {"z", place.z}}})}};
}

// Calls `write(note)` for each stored note. Does not check the notes again, because PUT has checked
// them; skips a note if `write` throws because the row is damaged.
template <class Write>
void for_each_note(const NoteSheet& sheet, const Write& write) {
  const auto notes = nlohmann::json::parse(sheet.text, nullptr, /*allow_exceptions=*/false);
  if (!notes.is_array()) return;
  for (const auto& note : notes) {
    try {
      write(note);
    } catch (const nlohmann::json::exception&) {
      continue;
    }
  }
}

// Answers with the notes as an annotation page. `version` is that of IIIF Presentation: 3 or 4.
Response show_annotations(int version, const Request& request, Services& services) {
  return with_model(request, services, [&](const auto& model) {
    const ModelRecord& record = model->record();
    const auto sheet = services.notes.find(record.id, NoteKind::kNotes);
    if (!sheet) return internal_error(sheet.error(), request, services);
    const std::string origin = origin_of(request, services);
    const std::string self =
        fmt::format("{}/api/v1/iiif/{}{}", origin, version == 4 ? "4/" : "", record.id.to_string());
    OrderedJson items = OrderedJson::array();
    for_each_note(*sheet, [&](const nlohmann::json& note) {
      OrderedJson target =
          version == 4 ? place_in_scene(note, record, self) : OrderedJson(self + "/canvas");
      items.push_back(annotation_of(note, self, origin, std::move(target)));
    });
    const auto context = fmt::format("http://iiif.io/api/presentation/{}/context.json", version);
    const OrderedJson page = {{"@context", context},
                              {"id", self + "/annotations.json"},
                              {"type", "AnnotationPage"},
                              {"items", std::move(items)}};
    return revalidated(fmt::format("application/ld+json;profile=\"{}\"", context),
                       page.dump(-1, ' ', false, OrderedJson::error_handler_t::replace));
  });
}

}  // namespace

static Response show_notes(const Request& request, Services& services) {
  return show_document(kNotesDocument, request, services);
}

static Response change_notes(const Request& request, Services& services) {
  return change_document(kNotesDocument, request, services);
}

static Response show_tours(const Request& request, Services& services) {
  return show_document(kToursDocument, request, services);
}

static Response change_tours(const Request& request, Services& services) {
  return change_document(kToursDocument, request, services);
}

static Response show_canvas_annotations(const Request& request, Services& services) {
  return show_annotations(3, request, services);
}

static Response show_scene_annotations(const Request& request, Services& services) {
  return show_annotations(4, request, services);
}

static constexpr std::string_view kNotesComponents = R"json({
"schemas": {
  "Note": {"type": "object", "required": ["id", "position", "texts"], "additionalProperties": false, "properties": {
    "id": {"type": "string", "pattern": "^[a-z0-9]{1,32}$"},
    "position": {"$ref": "#/components/schemas/Vector", "description": "A point of the surface in the coordinates of the file, which the presentation does not change"},
    "normal": {"$ref": "#/components/schemas/Vector", "description": "Direction of the surface in the coordinates of the file; not 0, 0, 0"},
    "texts": {"type": "object", "minProperties": 1, "maxProperties": 12, "description": "The texts by language (BCP 47)", "additionalProperties": {"$ref": "#/components/schemas/NoteText"}},
    "picture": {"type": "string", "maxLength": 1000, "description": "URL of a picture: it begins with `https://` and a host, or is a path on this server. At most 1000 bytes"},
    "view": {"type": "object", "required": ["direction"], "additionalProperties": false, "description": "The view to show with the note, in the coordinates of the file", "properties": {
      "direction": {"$ref": "#/components/schemas/Vector", "description": "From the model to the eye; not 0, 0, 0"},
      "target": {"$ref": "#/components/schemas/Vector", "description": "The point in the middle of the view; by default the centre of the model"},
      "zoom": {"type": "number", "minimum": 0.1, "maximum": 100, "default": 1, "description": "1 shows the whole model"}}},
    "light": {"type": "string", "pattern": "^(museum|studio|relief|raking,(360|3[0-5][0-9]|[12]?[0-9]{1,2}))$", "description": "The light to show with the note; raking light has an angle from 0 to 360"},
    "section": {"type": "string", "pattern": "^(|[xyz],(200|1?[0-9]{1,2})(,flip)?)$", "description": "The section to show with the note, such as `y,100` or `y,100,flip`: an axis and a position from 0 to 200, in the axes of the presented model; empty for none"}}},
  "NoteText": {"type": "object", "required": ["title"], "additionalProperties": false, "properties": {
    "title": {"type": "string", "minLength": 1, "maxLength": 200, "description": "One line of plain text of at most 200 bytes"},
    "text": {"type": "string", "maxLength": 8000, "description": "Plain text of at most 8000 bytes. An empty line separates paragraphs; a link is written as `[words](https://...)`"},
    "alt": {"type": "string", "maxLength": 8000, "description": "Description of the picture for screen readers: plain text of at most 8000 bytes"},
    "audio": {"type": "string", "maxLength": 1000, "description": "URL of a sound in this language: it begins with `https://` and a host, or is a path on this server. At most 1000 bytes"}}},
  "Notes": {"type": "object", "required": ["notes"], "additionalProperties": false, "properties": {
    "notes": {"type": "array", "maxItems": 100, "items": {"$ref": "#/components/schemas/Note"}}}},
  "Tour": {"type": "object", "required": ["id", "titles", "steps"], "additionalProperties": false, "properties": {
    "id": {"type": "string", "pattern": "^[a-z0-9]{1,32}$"},
    "titles": {"type": "object", "minProperties": 1, "maxProperties": 12, "description": "The title by language (BCP 47): one line of plain text of at most 200 bytes", "additionalProperties": {"type": "string", "minLength": 1, "maxLength": 200}},
    "steps": {"type": "array", "maxItems": 100, "items": {"type": "object", "required": ["note"], "additionalProperties": false, "properties": {
      "note": {"type": "string", "pattern": "^[a-z0-9]{1,32}$", "description": "ID of a note; viewers skip notes that do not exist"},
      "seconds": {"type": "number", "minimum": 1, "maximum": 600, "description": "Time until the next step; by default long enough to read the text"},
      "transition": {"enum": ["fly", "cut"], "default": "fly", "description": "How the camera moves to the note"}}}}}},
  "Tours": {"type": "object", "required": ["tours"], "additionalProperties": false, "properties": {
    "tours": {"type": "array", "maxItems": 20, "items": {"$ref": "#/components/schemas/Tour"}}}},
  "IiifAnnotations": {"type": "object", "required": ["@context", "id", "type", "items"], "properties": {
    "@context": {"type": "string"}, "id": {"type": "string"}, "type": {"const": "AnnotationPage"},
    "items": {"type": "array", "items": {"type": "object"}}}}
},
"parameters": {
  "notesIfMatch": {"name": "If-Match", "in": "header", "description": "The ETag of the notes or tours as last read; the response is 412 if they have changed since",
    "schema": {"type": "string"}}
}
})json";

static constexpr ApiRoute kNoteRoutes[] = {
    {.method = Method::kGet,
     .path = "/api/v1/models/{id}/notes",
     .handler = show_notes,
     .executor = Executor::kWorker,
     .doc = {.id = "getNotes",
             .summary = "Returns the notes on the model's surface.",
             .response = "Notes",
             .may_be_gzip = true}},
    {.method = Method::kPut,
     .path = "/api/v1/models/{id}/notes",
     .handler = change_notes,
     .executor = Executor::kDisk,
     .role = Role::kOperator,
     .body = BodyKind::kLargeJson,
     .doc = {.id = "putNotes",
             .summary = "Replaces all notes on the model's surface.",
             .parameters = "notesIfMatch",
             .request = "Notes",
             .response = "Notes"}},
    {.method = Method::kGet,
     .path = "/api/v1/models/{id}/tours",
     .handler = show_tours,
     .executor = Executor::kWorker,
     .doc = {.id = "getTours",
             .summary = "Returns the tours through the model's notes.",
             .response = "Tours",
             .may_be_gzip = true}},
    {.method = Method::kPut,
     .path = "/api/v1/models/{id}/tours",
     .handler = change_tours,
     .executor = Executor::kDisk,
     .role = Role::kOperator,
     .body = BodyKind::kLargeJson,
     .doc = {.id = "putTours",
             .summary = "Replaces all tours through the model's notes.",
             .parameters = "notesIfMatch",
             .request = "Tours",
             .response = "Tours"}},
    {.method = Method::kGet,
     .path = "/api/v1/iiif/{id}/annotations.json",
     .handler = show_canvas_annotations,
     .executor = Executor::kWorker,
     .doc = {.id = "getIiifAnnotations",
             .summary = "Returns the model's notes as an annotation page of IIIF Presentation 3.0, "
                        "on the canvas of the manifest.",
             .response = "IiifAnnotations",
             .response_type = "application/ld+json",
             .may_be_gzip = true}},
    {.method = Method::kGet,
     .path = "/api/v1/iiif/4/{id}/annotations.json",
     .handler = show_scene_annotations,
     .executor = Executor::kWorker,
     .doc = {.id = "getIiifSceneAnnotations",
             .summary = "Returns the model's notes as an annotation page of IIIF Presentation 4.0, "
                        "at points of the scene.",
             .response = "IiifAnnotations",
             .response_type = "application/ld+json",
             .may_be_gzip = true}},
};

const ApiNoun kAnnotations = {.routes = kNoteRoutes, .components = kNotesComponents};

}  // namespace vitrine::server
