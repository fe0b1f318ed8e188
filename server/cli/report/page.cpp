// SPDX-License-Identifier: Apache-2.0
#include "server/cli/report/page.h"

#include <fmt/format.h>

#include "server/cli/report/markup.h"
#include "server/cli/report/rate_plot.h"
#include "server/cli/report/style.h"

namespace vitrine::server {
namespace {

// Returns `part` as a percentage of `whole`, or 0 if `whole` is 0.
double percent(double part, double whole) {
  return whole > 0 ? 100 * part / whole : 0;
}

class Page {
 public:
  explicit Page(const PageContents& contents)
      : contents_(contents),
        manifest_(contents.manifest),
        finest_(manifest_.levels.back()),
        diagonal_(length(contents.size)),
        unit_(manifest_.unit.empty() ? "units" : escaped(manifest_.unit)) {}

  std::string write() const {
    const std::string name = escaped(contents_.name);
    return fmt::format(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\"/>\n"
        "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\"/>\n"
        "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; img-src data:; "
        "style-src 'unsafe-inline'\"/>\n"
        "<title>{0}</title>\n<style>{1}</style>\n</head>\n<body>\n<main>\n"
        "<header>\n<p class=\"kind\">Progressive mesh</p>\n<h1><bdi>{0}</bdi></h1>\n{2}</header>\n"
        "{3}{4}{5}{6}"
        "<footer>Vitrine {7}. Errors are distances between the surface as displayed and the input, "
        "the larger of both directions; the maximum is a bound, not a sample.</footer>\n"
        "</main>\n</body>\n</html>\n",
        name, kPageStyle, key_figures(), pictures(), plot(), table(), facts(), VITRINE_VERSION);
  }

 private:
  double bits_per_vertex(std::uint32_t level) const {
    return 8.0 * static_cast<double>(manifest_.cumulative_bytes(level)) /
           manifest_.levels[level].vertices;
  }

  static std::string figure(std::string_view what, const std::string& value,
                            const std::string& note) {
    return fmt::format("<div><dt>{}</dt><dd><strong>{}</strong>{}</dd></div>\n", what, value, note);
  }

  std::string key_figures() const {
    const LevelInfo& base = manifest_.levels.front();
    const double share = percent(static_cast<double>(manifest_.file_bytes),
                                 static_cast<double>(contents_.input_bytes));
    return "<dl class=\"key\">\n" +
           figure("Triangles", count_text(finest_.faces),
                  count_text(finest_.vertices) + " vertices") +
           figure("Whole file", bytes_text(manifest_.file_bytes),
                  fmt::format("{} % of the input, {} bits per vertex", significant(share),
                              significant(bits_per_vertex(last_level())))) +
           figure("First view", bytes_text(manifest_.head_bytes()),
                  fmt::format("the whole object in {} triangles", count_text(base.faces))) +
           figure("Full resolution",
                  significant(percent(finest_.max_error, diagonal_)) + "\xC2\xA0%",
                  "of the diagonal at most off the input, by rounding to the grid") +
           "</dl>\n";
  }

  std::uint32_t last_level() const {
    return static_cast<std::uint32_t>(manifest_.levels.size() - 1);
  }

  std::string pictures() const {
    std::string out = "<section>\n<h2>Levels of detail</h2>\n<div class=\"pictures\">\n";
    for (const LevelPicture& picture : contents_.pictures) {
      const std::string faces = count_text(manifest_.levels[picture.level].faces) + " triangles";
      out += fmt::format(
          "<figure><img alt=\"Level {0}, {1}\" width=\"{2}\" height=\"{3}\" "
          "src=\"data:image/png;base64,{4}\"/>"
          "<figcaption><b>{1}</b>level {0}, {5}</figcaption></figure>\n",
          picture.level, faces, picture.width, picture.height, base64(picture.png),
          bytes_text(manifest_.cumulative_bytes(picture.level)));
    }
    return out + "</div>\n</section>\n";
  }

  std::string plot() const {
    RateSeries rms{"ours", "this file: rms error", {}};
    RateSeries bound{"bound", "this file: maximum error", {}};
    RateSeries peer{"peer", "a file for each level of detail: rms error", {}};
    for (std::uint32_t l = 0; l < manifest_.levels.size(); ++l) {
      const LevelInfo& level = manifest_.levels[l];
      const auto bytes = static_cast<double>(manifest_.cumulative_bytes(l));
      rms.points.push_back({bytes, percent(level.rms_error, diagonal_)});
      bound.points.push_back({bytes, percent(level.max_error, diagonal_)});
    }
    for (const SingleFile& file : contents_.single_files) {
      peer.points.push_back({static_cast<double>(file.bytes), percent(file.rms_error, diagonal_)});
    }
    const std::string drawing = rate_plot({rms, bound, peer});
    if (drawing.empty()) return {};
    return "<section>\n<h2>Bytes and error</h2>\n<figure><div class=\"scroll\">" + drawing +
           "</div>"
           "<figcaption class=\"note\">Each mark of this file is a level, reached after that many "
           "of its bytes; all its marks are one file. The dashed line is what separate files take: "
           "the input simplified by meshoptimizer, which leaves the vertices it keeps in their "
           "places, and coded by Draco at its smallest on each grid. Only files that no smaller "
           "file "
           "equals are drawn. Each of its marks is one more file to store and to "
           "load.</figcaption></figure>\n</section>\n";
  }

  std::string table() const {
    std::string out = fmt::format(
        "<section>\n<h2>Levels</h2>\n<div class=\"scroll\"><table>\n<thead>"
        "<tr><th colspan=\"4\"></th><th>bytes</th><th>bits per</th><th>rms error</th><th></th>"
        "<th>maximum</th><th></th></tr>"
        "<tr><th>level</th><th>triangles</th><th>vertices</th><th>bytes</th><th>so far</th>"
        "<th>vertex</th><th>{0}</th><th>%</th><th>{0}</th><th>%</th></tr></thead>\n<tbody>\n",
        unit_);
    std::uint64_t before = 0;
    for (std::uint32_t l = 0; l < manifest_.levels.size(); ++l) {
      const LevelInfo& level = manifest_.levels[l];
      const std::uint64_t bytes = manifest_.cumulative_bytes(l);
      out += fmt::format(
          "<tr><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td>"
          "<td>{}</td><td>{}</td><td>{}</td></tr>\n",
          count_data(l), count_data(level.faces), count_data(level.vertices),
          count_data(bytes - before), count_data(bytes), number_data(bits_per_vertex(l)),
          number_data(level.rms_error), significant(percent(level.rms_error, diagonal_)),
          number_data(level.max_error), significant(percent(level.max_error, diagonal_)));
      before = bytes;
    }
    return out +
           "</tbody>\n</table></div>\n<p class=\"note\">Percentages are of the diagonal of "
           "the bounding box, " +
           significant(diagonal_) + " " + unit_ + ".</p>\n</section>\n";
  }

  static std::string fact(std::string_view what, const std::string& value) {
    return fmt::format("<dt>{}</dt><dd>{}</dd>\n", what, value);
  }

  std::string repairs() const {
    const auto& repairs = contents_.input.repairs;
    if (repairs.empty()) return "none was needed";
    std::string out = "<ul>";
    for (const std::string& repair : repairs)
      out += "<li>" + escaped(repair) + "</li>";
    return out + "</ul>";
  }

  std::string facts() const {
    const BuildReport::Input& input = contents_.input;
    const Vec3& size = contents_.size;
    return "<section class=\"facts\">\n<div><h2>Input</h2>\n<dl>\n" +
           fact("Bytes", count_text(contents_.input_bytes)) +
           fact("Triangles", count_text(input.faces)) +
           fact("Vertices", count_text(input.vertices)) +
           fact("Parts", count_text(input.components)) +
           fact("Open edges", count_text(input.boundary_edges)) +
           fact("Size", fmt::format("{} \xC3\x97 {} \xC3\x97 {} {}", significant(size.x),
                                    significant(size.y), significant(size.z), unit_)) +
           fact("Repairs", repairs()) + "</dl>\n</div>\n<div><h2>File</h2>\n<dl>\n" +
           fact("Format", fmt::format("pmesh {}.{}", kFormatMajor, kFormatMinor)) +
           fact("Grid", fmt::format("{} bits, step {} {}", manifest_.lattice.bits,
                                    significant(manifest_.lattice.step), unit_)) +
           fact("Placement", manifest_.placement == Placement::kPyramid ? "pyramid" : "midpoint") +
           fact("Colours", manifest_.has(Semantic::kColour) ? "one per vertex" : "none") +
           fact("Header, base mesh", count_text(manifest_.base_offset) + " + " +
                                         count_text(manifest_.base_length) + " bytes") +
           fact("Layers", fmt::format("{} chunks, {} bytes", count_text(manifest_.chunks.size()),
                                      count_text(manifest_.chunk_bytes()))) +
           fact("SHA-256", "<code>" + to_hex(contents_.sha256) + "</code>") +
           "</dl>\n</div>\n</section>\n";
  }

  const PageContents& contents_;
  const Manifest& manifest_;
  const LevelInfo& finest_;
  double diagonal_;
  std::string unit_;
};

}  // namespace

std::string write_page(const PageContents& contents) {
  return Page(contents).write();
}

}  // namespace vitrine::server
