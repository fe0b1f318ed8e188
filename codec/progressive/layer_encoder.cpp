// SPDX-License-Identifier: Apache-2.0
#include "codec/progressive/layer_encoder.h"

#include <memory>

#include "codec/progressive/layer_pass.h"
#include "codec/progressive/region_fork.h"

namespace vitrine {
namespace {

constexpr std::uint32_t kNone = 0xFFFF'FFFFu;

// Tells the pass what the recorded collapses of one level undo.
class Replay {
 public:
  Replay(const CollapseLevel& collapses, const std::vector<std::uint32_t>& collapse_of,
         std::vector<VertexId>& fine, std::vector<VertexId>& state,
         const std::vector<VertexId>& loop)
      : collapses_(collapses), collapse_of_(collapse_of), fine_(fine), state_(state), loop_(loop) {}

  bool find(VertexId v, SplitTruth& told) {
    const std::uint32_t k = collapse_of_[fine_[v]];
    if (k == kNone) return false;
    const Collapse& c = collapses_[k];
    // The new vertex is v2: its faces run from apex21 round to apex12.
    told = {to_state(c.apex21), to_state(c.apex12), c.p1 - c.p2, c.c1 - c.c2};
    return true;
  }

  void applied(VertexId v, VertexId w, bool swapped) {
    const Collapse& c = collapses_[collapse_of_[fine_[v]]];
    fine_.push_back(swapped ? c.v1 : c.v2);
    fine_[v] = swapped ? c.v2 : c.v1;
    state_[fine_[v]] = v;
    state_[fine_[w]] = w;
  }

 private:
  VertexId to_state(VertexId fine) const {
    return is_virtual(fine) ? loop_[fine & ~kVirtualBit] : state_[fine];
  }

  const CollapseLevel& collapses_;
  const std::vector<std::uint32_t>& collapse_of_;
  std::vector<VertexId>& fine_;
  std::vector<VertexId>& state_;
  const std::vector<VertexId>& loop_;
};

VertexId virtual_neighbour(const Connectivity& mesh, VertexId v) {
  Corner c = mesh.corner_at(v);
  while (!is_virtual(mesh.vertex(next(c))))
    c = mesh.swing(c);
  return mesh.vertex(next(c));
}

}  // namespace

Expected<LayerEncoder> LayerEncoder::start(const Hierarchy& hierarchy, const BaseMesh& base,
                                           std::vector<VertexId> fine_ids) {
  auto mesh = MeshState::from_base(base);
  if (!mesh) return tl::unexpected(mesh.error());
  LayerEncoder encoder(hierarchy, std::move(*mesh));
  encoder.fine_ = std::move(fine_ids);
  encoder.state_.assign(hierarchy.region.size(), kNone);
  encoder.collapse_of_.assign(hierarchy.region.size(), kNone);
  for (VertexId v = 0; v < encoder.fine_.size(); ++v)
    encoder.state_[encoder.fine_[v]] = v;
  for (const std::uint32_t member : hierarchy.loop_member) {
    const VertexId v = encoder.state_[hierarchy.base_ids[member]];
    encoder.loop_.push_back(virtual_neighbour(encoder.mesh_.connectivity, v));
  }
  return encoder;
}

Expected<std::vector<EncodedChunk>> LayerEncoder::encode_level() {
  const CollapseLevel& collapses = hierarchy_->levels[level_];
  ++level_;
  const bool forked = level_ >= hierarchy_->fork_level;
  const std::uint32_t regions = forked ? hierarchy_->regions : 1;
  std::vector<EncodedChunk> chunks(regions);
  for (std::uint32_t k = 0; k < collapses.size(); ++k) {
    collapse_of_[collapses[k].v1] = k;
    ++chunks[forked ? hierarchy_->region[collapses[k].v1] : 0].splits;
  }
  Replay replay(collapses, collapse_of_, fine_, state_, loop_);
  const auto last = static_cast<std::uint32_t>(hierarchy_->levels.size());
  for (std::uint32_t k = 0; k < regions; ++k) {
    const ChunkFrame frame{.level = level_,
                           .region = static_cast<std::uint16_t>(k),
                           .splits = chunks[k].splits,
                           .placement = hierarchy_->placement,
                           .parity = level_parity(level_, last)};
    RangeEncoder coder;
    const auto pass =
        std::make_unique<LayerPass<RangeEncoder, Replay>>(mesh_, frame, coder, replay);
    if (auto ok = pass->run(); !ok) return tl::unexpected(ok.error());
    if (hierarchy_->regions > 1 && level_ + 1 == hierarchy_->fork_level) {
      const auto label = [&](VertexId v) { return hierarchy_->region[fine_[v]]; };
      if (auto ok = code_fork(mesh_, coder, hierarchy_->planes, label); !ok) {
        return tl::unexpected(ok.error());
      }
    }
    chunks[k].region = static_cast<std::uint16_t>(k);
    chunks[k].bytes = coder.finish();
  }
  for (const Collapse& c : collapses)
    collapse_of_[c.v1] = kNone;
  return chunks;
}

}  // namespace vitrine
