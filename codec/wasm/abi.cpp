// SPDX-License-Identifier: Apache-2.0
// The decoder and planner as a WebAssembly module: a C ABI over Refiner and Planner. The caller
// (web/src/core/decoder.ts) copies bytes in with `allocate` and reads arrays out through pointers,
// which are valid until the next call on the same model. Sizes that may pass 2^32 are doubles.
// Every function is safe on hostile bytes; 0 (or -1) means failure and `error_text` says why.
#include <algorithm>
#include <memory>
#include <new>
#include <string>

#include "codec/wasm/model.h"

#define VITRINE_EXPORT(name) extern "C" __attribute__((export_name(#name), used))

namespace {

using vitrine::Model;

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

// The length of the header that `data` (kHeaderPrefix bytes or more) begins, or -1.
VITRINE_EXPORT(header_length) double header_length(const std::uint8_t* data, std::uint32_t size) {
  auto length = vitrine::header_bytes(bytes_at(data, size));
  return succeeded(length) ? static_cast<double>(*length) : -1;
}

VITRINE_EXPORT(model_open) Model* model_open(const std::uint8_t* data, std::uint32_t size) {
  auto model = Model::open(bytes_at(data, size));
  return succeeded(model) ? model->release() : nullptr;
}

// The manifest as numbers; see Model::summary for the layout.
VITRINE_EXPORT(summary) const double* summary(Model* model) {
  return model->summary().data();
}
VITRINE_EXPORT(summary_length) std::uint32_t summary_length(Model* model) {
  return static_cast<std::uint32_t>(model->summary().size());
}
VITRINE_EXPORT(unit) const char* unit(Model* model) {
  return model->manifest().unit.c_str();
}

// The SHA-256 of a chunk, 32 bytes, or null where there is no such chunk.
VITRINE_EXPORT(chunk_hash) const std::uint8_t* chunk_hash(Model* model, std::uint32_t chunk) {
  const auto& chunks = model->manifest().chunks;
  return chunk < chunks.size() ? chunks[chunk].sha256.data() : nullptr;
}

VITRINE_EXPORT(check_base)
int check_base(Model* model, const std::uint8_t* data, std::uint32_t size) {
  return succeeded(model->check_base(bytes_at(data, size)));
}

// `positions` 3 lattice coordinates a vertex, `faces` 3 indices each, `colours` 3 YCoCg-R values a
// vertex or null.
VITRINE_EXPORT(start)
int start(Model* model, const vitrine::Vec3i* positions, std::uint32_t vertices,
          const vitrine::Triangle* faces, std::uint32_t face_count, const vitrine::Vec3i* colours) {
  vitrine::BaseMesh base;
  base.positions = {positions, positions + vertices};
  base.faces = {faces, faces + face_count};
  if (colours != nullptr) base.colours = {colours, colours + vertices};
  return succeeded(model->start(std::move(base)));
}

// kind: 0 triangles, 1 bytes, 2 error in model units, 3 level. Returns 1 where the surface went
// back to the base mesh first, 0 where refinement goes on from the present state, -1 on failure.
VITRINE_EXPORT(want) int want(Model* model, std::uint32_t kind, double value) {
  auto restarted = model->want(kind, value);
  return succeeded(restarted) ? (*restarted ? 1 : 0) : -1;
}

// The goal of a camera: 22 numbers, those of View in its order and the most triangles to
// hold. Returns what want() does.
VITRINE_EXPORT(want_view) int want_view(Model* model, const double* numbers) {
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

// The next chunk to request, which then counts as requested; -1 where the want is met.
VITRINE_EXPORT(next_chunk) int next_chunk(Model* model) {
  return model->next_chunk();
}

// 0: damaged in transit, worth another request. To be called before apply().
VITRINE_EXPORT(check_chunk)
int check_chunk(Model* model, std::uint32_t chunk, const std::uint8_t* data, std::uint32_t size) {
  return succeeded(model->check_chunk(chunk, bytes_at(data, size)));
}

// After a failure want() starts over.
VITRINE_EXPORT(apply)
int apply(Model* model, std::uint32_t chunk, const std::uint8_t* data, std::uint32_t size) {
  return succeeded(model->apply(chunk, bytes_at(data, size)));
}

// Once all chunks of a want are applied: takes back the splits beyond it.
VITRINE_EXPORT(trim) void trim(Model* model) {
  model->trim();
}

VITRINE_EXPORT(bytes_held) double bytes_held(Model* model) {
  return model->bytes_held();
}
VITRINE_EXPORT(vertex_count) std::uint32_t vertex_count(Model* model) {
  return model->refiner().vertex_count();
}
// Whose split by the chunk applied last brought the vertex; itself where none did.
VITRINE_EXPORT(parent_of) std::uint32_t parent_of(Model* model, std::uint32_t vertex) {
  return model->refiner().parent_of(vertex);
}
VITRINE_EXPORT(face_count) std::uint32_t face_count(Model* model) {
  return model->refiner().face_count();
}

// The displayed surface comes in pieces: after display(), each call fills the arrays below with the
// next vertices or faces and says how many; 0 at the end.
VITRINE_EXPORT(display) void display(Model* model) {
  model->display();
}
VITRINE_EXPORT(next_vertices) std::uint32_t next_vertices(Model* model) {
  return model->next_vertices();
}
VITRINE_EXPORT(next_faces) std::uint32_t next_faces(Model* model) {
  return model->next_faces();
}
// 3 floats a vertex, model units from the centre of the base mesh's bounding box (see summary).
VITRINE_EXPORT(positions) const float* positions(Model* model) {
  return model->positions().data()->data();
}
// 4 signed 16-bit a vertex: the normal times 32767, and 0.
VITRINE_EXPORT(normals) const std::int16_t* normals(Model* model) {
  return model->normals().data()->data();
}
// 3 sRGB bytes a vertex, or null.
VITRINE_EXPORT(colours) const std::uint8_t* colours(Model* model) {
  return model->colours().empty() ? nullptr : model->colours().data()->data();
}
// 3 lattice coordinates a vertex, exact.
VITRINE_EXPORT(lattice_positions) const std::int32_t* lattice_positions(Model* model) {
  return &model->lattice_positions().data()->x;
}
// 3 indices a real face.
VITRINE_EXPORT(indices) const std::uint32_t* indices(Model* model) {
  return model->faces().data()->data();
}
