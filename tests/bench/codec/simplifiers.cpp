// SPDX-License-Identifier: Apache-2.0
#include <string>
#include <utility>

#include "error_curves.h"
#include "peer_simplifiers.h"
#include "processor_time.h"
#include "sections.h"
#include "single_files.h"
#include "subject.h"
#include "support/product_names.h"

namespace vitrine::bench {
namespace {

constexpr std::size_t kShare = 10;  // the simplifiers keep one of every kShare faces

// Returns the result of the last of three runs, because Node has compiled the hot code by then.
Simplified meshopt_update(const TriangleMesh& mesh, std::size_t faces) {
  return std::move(simplify_by_meshopt_update(mesh, {faces, faces, faces}).back());
}

struct PeerSimplifier {
  const char* name;
  Simplified (*simplify)(const TriangleMesh&, std::size_t faces);
};
constexpr PeerSimplifier kPeers[] = {
    {"meshopt", simplify_by_meshopt},
    {"meshopt_update", meshopt_update},
    {"openmesh", simplify_by_openmesh},
#ifdef VITRINE_BENCH_CGAL
    {"garland_heckbert", simplify_by_garland_heckbert},
    {"lindstrom_turk", simplify_by_lindstrom_turk},
#endif
};

}  // namespace

void simplifiers(Report& report, const BenchmarkModel& model) {
  Bytes pmesh;
  const double own_time = seconds([&] { pmesh = build(model.file, kBits); });
  const auto own_errors = error_curves(pmesh, model.clean).by_faces;
  const std::string what = "simplify." + model.name;
  for (const PeerSimplifier& peer : kPeers) {
    const Simplified theirs = peer.simplify(model.clean, model.clean.faces.size() / kShare);
    const double error = rms_percent(theirs.mesh, model.clean);
    const double own = error_at(own_errors, static_cast<double>(theirs.mesh.faces.size()));
    const std::string name = peer.name;
    report.add({what, "rms_ratio_to_" + name, own, error, own / error, kNoThreshold});
    report.add({what, "time_ratio_to_" + name, own_time, theirs.seconds, own_time / theirs.seconds,
                kNoThreshold});
  }
}

}  // namespace vitrine::bench
