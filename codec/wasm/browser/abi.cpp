// SPDX-License-Identifier: Apache-2.0
// The C interface of the WebAssembly module: functions over Refiner and Planner. The caller
// (web/src/core/decoder.ts) copies bytes in with `allocate` and reads arrays through pointers. A
// pointer is valid until the next call for the same model. Sizes that may exceed 2^32 are doubles.
// Every function is safe on hostile bytes. A function that can fail returns 0 or -1 on failure, and
// `error_text` then returns the reason.
#include <algorithm>
#include <memory>
#include <new>
#include <string>
#include <utility>

#include "codec/base/base_decoder.h"
#include "codec/wasm/browser_model.h"

#define VITRINE_EXPORT(name) extern "C" __attribute__((export_name(#name), used))

namespace {

using vitrine::BrowserModel;

std::string& last_error() {
  static std::string text;
  return text;
}

template <class Result>
bool succeeded(Result&& result) {
  if (!result) last_error() = std::move(result.error().message);
  return result.has_value();
}

std::span<const std::uint8_t> bytes_at(const std::uint8_t* data, std::uint32_t size) {
  return {data, size};
}

}  // namespace

VITRINE_EXPORT(allocate) void* allocate(std::uint32_t size) {
  return operator new(size, std::nothrow);
}
VITRINE_EXPORT(release) void release(void* pointer) {
  operator delete(pointer);
}
VITRINE_EXPORT(error_text) const char* error_text() {
  return last_error().c_str();
}

// Returns the length of the header in bytes, or -1 on failure. `data` must hold at least the first
// kHeaderPrefix bytes of the file.
VITRINE_EXPORT(header_length) double header_length(const std::uint8_t* data, std::uint32_t size) {
  auto length = vitrine::header_bytes(bytes_at(data, size));
  return succeeded(length) ? static_cast<double>(*length) : -1;
}

VITRINE_EXPORT(model_open) BrowserModel* model_open(const std::uint8_t* data, std::uint32_t size) {
  auto model = BrowserModel::open(bytes_at(data, size));
  return succeeded(model) ? model->release() : nullptr;
}

// Returns the manifest as numbers. BrowserModel::summary() describes the layout.
VITRINE_EXPORT(summary) const double* summary(BrowserModel* model) {
  return model->summary().data();
}
VITRINE_EXPORT(summary_length) std::uint32_t summary_length(BrowserModel* model) {
  return static_cast<std::uint32_t>(model->summary().size());
}
VITRINE_EXPORT(unit) const char* unit(BrowserModel* model) {
  return model->manifest().unit.c_str();
}

// Returns the SHA-256 of a chunk (32 bytes), or null if the chunk does not exist.
VITRINE_EXPORT(chunk_hash)
const std::uint8_t* chunk_hash(BrowserModel* model, std::uint32_t chunk) {
  const auto& chunks = model->manifest().chunks;
  return chunk < chunks.size() ? chunks[chunk].sha256.data() : nullptr;
}

// Checks the SHA-256 of a picture. Returns 0 if the picture was damaged in transit.
VITRINE_EXPORT(check_picture)
int check_picture(BrowserModel* model, std::uint32_t picture, const std::uint8_t* data,
                  std::uint32_t size) {
  return succeeded(model->check_picture(picture, bytes_at(data, size)));
}
// Returns the SHA-256 of a picture (32 bytes), or null if the picture does not exist.
VITRINE_EXPORT(picture_hash)
const std::uint8_t* picture_hash(BrowserModel* model, std::uint32_t picture) {
  const auto& pictures = model->manifest().texture.pictures;
  return picture < pictures.size() ? pictures[picture].sha256.data() : nullptr;
}

VITRINE_EXPORT(check_base)
int check_base(BrowserModel* model, const std::uint8_t* data, std::uint32_t size) {
  return succeeded(model->check_base(bytes_at(data, size)));
}

VITRINE_EXPORT(check_atlas)
int check_atlas(BrowserModel* model, const std::uint8_t* data, std::uint32_t size) {
  return succeeded(model->check_atlas(bytes_at(data, size)));
}

// Starts at the base mesh. `base` holds the Draco buffer of the base mesh. `atlas` holds its coded
// texture coordinates; `atlas_size` is 0 if the model has no texture. The caller must have checked
// the SHA-256 of both.
VITRINE_EXPORT(start)
int start(BrowserModel* model, const std::uint8_t* base, std::uint32_t base_size,
          const std::uint8_t* atlas, std::uint32_t atlas_size) {
  auto decoded = vitrine::decode_base(bytes_at(base, base_size), model->manifest());
  return succeeded(decoded) &&
         succeeded(model->start(std::move(*decoded), bytes_at(atlas, atlas_size)));
}

// Sets the detail target. `kind` is 0 for a number of triangles, 1 for a number of bytes, 2 for an
// error in model units, 3 for a level. Returns 1 if the surface restarts from the base mesh, 0 if
// refinement continues from the current state, or -1 on failure.
VITRINE_EXPORT(want) int want(BrowserModel* model, std::uint32_t kind, double value) {
  auto restarted = model->want(kind, value);
  return succeeded(restarted) ? (*restarted ? 1 : 0) : -1;
}

// Sets a camera as the detail target. `numbers` holds 22 numbers: the members of View in their
// order, then the maximum number of triangles. Returns the same values as want().
VITRINE_EXPORT(want_view) int want_view(BrowserModel* model, const double* numbers) {
  vitrine::View view;
  std::copy_n(numbers, view.camera.size(), view.camera.begin());
  view.field_of_view = numbers[16];
  view.width = numbers[17];
  view.height = numbers[18];
  view.pixel_error = numbers[19];
  view.bytes = numbers[20];
  if (!is_sane(view)) {
    last_error() =
        std::string("the camera is impossible: its numbers must be finite, its sizes above 0");
    return -1;
  }
  auto restarted = model->want(view, numbers[21]);
  return succeeded(restarted) ? (*restarted ? 1 : 0) : -1;
}

// Returns the next chunk to request and marks it as requested. Returns -1 if the detail target is
// reached.
VITRINE_EXPORT(next_chunk) int next_chunk(BrowserModel* model) {
  return model->next_chunk();
}

// Checks the SHA-256 of a chunk; call this before apply(). Returns 0 if the chunk was damaged in
// transit; the caller should then request it again.
VITRINE_EXPORT(check_chunk)
int check_chunk(BrowserModel* model, std::uint32_t chunk, const std::uint8_t* data,
                std::uint32_t size) {
  return succeeded(model->check_chunk(chunk, bytes_at(data, size)));
}

// Applies a chunk. Returns 0 on failure; the next want() then restarts from the base mesh.
VITRINE_EXPORT(apply)
int apply(BrowserModel* model, std::uint32_t chunk, const std::uint8_t* data, std::uint32_t size) {
  return succeeded(model->apply(chunk, bytes_at(data, size)));
}

// Undoes the splits that exceed the detail target. Call this once all chunks for the target have
// been applied.
VITRINE_EXPORT(trim) void trim(BrowserModel* model) {
  model->trim();
}

VITRINE_EXPORT(bytes_held) double bytes_held(BrowserModel* model) {
  return model->bytes_held();
}
// Returns the number of displayed vertices.
VITRINE_EXPORT(vertex_count) std::uint32_t vertex_count(BrowserModel* model) {
  return model->displayed_vertices();
}
// Returns the displayed vertex that the last applied chunk split to create `vertex`. Returns
// `vertex` itself if that chunk did not create it by a split.
VITRINE_EXPORT(parent_of) std::uint32_t parent_of(BrowserModel* model, std::uint32_t vertex) {
  return model->parent_of(vertex);
}
VITRINE_EXPORT(face_count) std::uint32_t face_count(BrowserModel* model) {
  return model->refiner().face_count();
}

// The displayed surface is returned in pieces. Call display() first. Each call of next_vertices()
// or next_faces() then fills the arrays below with the next vertices or faces, and returns their
// number, or 0 at the end.
VITRINE_EXPORT(display) void display(BrowserModel* model) {
  model->display();
}
VITRINE_EXPORT(next_vertices) std::uint32_t next_vertices(BrowserModel* model) {
  return model->next_vertices();
}
VITRINE_EXPORT(next_faces) std::uint32_t next_faces(BrowserModel* model) {
  return model->next_faces();
}
// Returns 3 floats per vertex, in model units, relative to the centre of the base mesh's bounding
// box (see summary).
VITRINE_EXPORT(positions) const float* positions(BrowserModel* model) {
  return model->positions().data()->data();
}
// Returns 4 signed 16-bit integers per vertex: the three components of the unit normal times 32767,
// then 0.
VITRINE_EXPORT(normals) const std::int16_t* normals(BrowserModel* model) {
  return model->normals().data()->data();
}
// Returns the values of attribute i of the model. A colour has 3 sRGB bytes per vertex.
VITRINE_EXPORT(attribute_values)
const void* attribute_values(BrowserModel* model, std::uint32_t i) {
  const void* values = nullptr;
  model->attributes().for_each([&](vitrine::Semantic semantic, const auto& column) {
    if (semantic == model->manifest().attributes[i]) values = column.data();
  });
  return values;
}
// Returns 3 integers per vertex: the exact lattice coordinates.
VITRINE_EXPORT(lattice_positions) const std::int32_t* lattice_positions(BrowserModel* model) {
  return &model->lattice_positions().data()->x;
}
// Returns 2 floats per vertex: the texture coordinates (see BrowserModel::coordinates()). Returns
// null if the model has no texture.
VITRINE_EXPORT(texture_coordinates) const float* texture_coordinates(BrowserModel* model) {
  return model->coordinates().empty() ? nullptr : model->coordinates().data()->data();
}
// Returns 3 vertex indices per real face.
VITRINE_EXPORT(indices) const std::uint32_t* indices(BrowserModel* model) {
  return model->faces().data()->data();
}
