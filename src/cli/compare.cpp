// gaussdrift compare: how far two results are apart.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "base/number.hpp"
#include "cli/laid_out.hpp"
#include "cli/outputs_of.hpp"
#include "cli/terminal.hpp"
#include "cli/verbs.hpp"
#include "reference/norms.hpp"

namespace gaussdrift::cli {

namespace fs = std::filesystem;

namespace {

using nlohmann::ordered_json;
using read::WrittenOutput;

struct CompareOptions {
  fs::path first, second;
  std::string field = "rho";  // an array of the density files
  double tolerance = -1;      // negative: none
  bool json = false;
};

void declare(OptionList& options, CompareOptions& given) {
  options.add("first", given.first, "A", "folder of a run, or a .vti or .pvti").required();
  options.add("second", given.second, "B", "what it is compared with").required();
  options.add("--tolerance", given.tolerance, "X", "exit code 5 if the largest difference is above this")
      .not_negative();
  options.add("--field", given.field, "NAME", fmt::format("{}; rho by default", fmt::join(arrays_of_outputs(), ", ")))
      .offers(arrays_of_outputs);
  options.json(given.json);
}

/// "50 x 50 points from (0, 0) with spacing 0.02".
std::string described(const Lattice& lattice) {
  std::vector<std::size_t> points;
  std::vector<double> origin;
  for (int k = 0; k < lattice.dimension; ++k) {
    points.push_back(lattice.points[k]);
    origin.push_back(lattice.origin[k]);
  }
  return fmt::format("{} points from ({:.10g}) with spacing {:.10g}", fmt::join(points, " x "), fmt::join(origin, ", "),
                     lattice.spacing);
}

std::string in_text(std::optional<double> time) { return time ? fmt::format("t = {:g}", *time) : "no time"; }

bool same_time(double a, double b) { return std::abs(a - b) <= 1e-9 * std::max(std::abs(a), std::abs(b)); }

/// Outputs of two runs that belong together, as indices, and those that have no partner.
struct Partners {
  std::vector<std::pair<std::size_t, std::size_t>> pairs;
  std::vector<std::size_t> first_alone, second_alone;
};

/// Two single outputs belong together whatever their times; others if their times agree, or if neither has one, in
/// their order.
Partners partners_of(const std::vector<WrittenOutput>& a, const std::vector<WrittenOutput>& b) {
  if (a.size() == 1 && b.size() == 1) return {.pairs = {{0, 0}}, .first_alone = {}, .second_alone = {}};
  Partners partners;
  std::vector<bool> taken(b.size(), false);
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t j = 0;
    while (j < b.size() && (taken[j] || a[i].time.has_value() != b[j].time.has_value() ||
                            (a[i].time && !same_time(*a[i].time, *b[j].time))))
      ++j;
    if (j == b.size()) {
      partners.first_alone.push_back(i);
      continue;
    }
    taken[j] = true;
    partners.pairs.emplace_back(i, j);
  }
  for (std::size_t j = 0; j < b.size(); ++j)
    if (!taken[j]) partners.second_alone.push_back(j);
  return partners;
}

/// "t = 0, 0.5 and 1", at most the first and the last where they are many.
std::string times_text(const std::vector<WrittenOutput>& outputs) {
  std::vector<std::string> times;
  for (const auto& output : outputs) times.push_back(output.time ? fmt::format("{:g}", *output.time) : "none");
  if (times.size() > 8) return fmt::format("{} from t = {} to {}", times.size(), times.front(), times.back());
  return fmt::format("t = {}", fmt::join(times, ", "));
}

ordered_json time_in_json(std::optional<double> time) { return time ? ordered_json(*time) : nullptr; }

/// Warns of outputs that are not compared, and adds them to the list.
void tell_alone(const std::vector<WrittenOutput>& outputs, const std::vector<std::size_t>& which, const fs::path& other,
                ordered_json& list) {
  for (const std::size_t i : which) {
    note("warning: {} ({}) is not compared: {} has no output at that time\n", outputs[i].file.string(),
         in_text(outputs[i].time), other.string());
    list.push_back({{"file", outputs[i].file.string()}, {"t", time_in_json(outputs[i].time)}});
  }
}

bool same_grid(const Lattice& a, const Lattice& b) {
  const double same = 1e-6 * a.spacing;
  const auto apart_by = [&](std::size_t k) { return std::abs(a.origin[k] - b.origin[k]); };
  return a.points == b.points && std::abs(a.spacing - b.spacing) <= same * 1e-3 && apart_by(0) <= same &&
         apart_by(1) <= same && apart_by(2) <= same;
}

/// Calls use(x, y) with the values of both at every point, piece by piece.
template <class Use>
void at_all_points(read::StoredDensity& a, read::StoredDensity& b, const Use& use) {
  for (std::size_t i = 0; i < a.pieces(); ++i)
    for (std::size_t j = 0; j < b.pieces(); ++j) {
      const LatticeBox both = common(a.own(i), b.own(j));
      if (both.size() == 0) continue;
      const std::vector<double>&x = a.values(i), &y = b.values(j);
      for (std::size_t l = both.first[2]; l < both.end(2); ++l)
        for (std::size_t k = both.first[1]; k < both.end(1); ++k) {
          const double *from_x = x.data() + a.shown(i).number(both.first[0], k, l),
                       *from_y = y.data() + b.shown(j).number(both.first[0], k, l);
          for (std::size_t p = 0; p < both.points[0]; ++p) use(from_x[p], from_y[p]);
        }
    }
}

/// As gaussdrift::compare() has them, over the components of vectors as over further points. Pieces are read twice, because
/// all of them at once may not fit into memory.
ErrorNorms difference_of_pieces(std::vector<std::pair<read::StoredDensity, read::StoredDensity>>& components) {
  double largest_error = 0, largest = 0;
  const auto everywhere = [&](const auto& use) {
    for (auto& [a, b] : components) at_all_points(a, b, use);
  };
  everywhere([&](double x, double y) {
    if (std::isnan(y)) return;
    largest_error = std::max(largest_error, std::abs(x - y));
    largest = std::max(largest, std::abs(y));
  });
  if (!(largest > 0)) return {NAN, NAN, largest_error == 0 ? 0.0 : INFINITY};
  double error_1 = 0, error_2 = 0, norm_1 = 0, norm_2 = 0;
  everywhere([&](double x, double y) {
    if (std::isnan(y)) return;
    const double error = std::abs(x - y) / largest, size = std::abs(y) / largest;
    error_1 += error, error_2 += error * error;
    norm_1 += size, norm_2 += size * size;
  });
  return {error_1 / norm_1, std::sqrt(error_2 / norm_2), largest_error / largest};
}

ErrorNorms difference(const WrittenOutput& first, const WrittenOutput& second, const std::string& field) {
  read::StoredDensity a(first.file, field), b(second.file, field);
  if (!same_grid(a.lattice(), b.lattice()))
    throw FileError(fmt::format(
        "{} and {} are on different grids, {} and {}; run one of them with the domain and [evaluate] of the other",
        first.file.string(), second.file.string(), described(a.lattice()), described(b.lattice())));
  const std::size_t components = a.components();
  if (b.components() != components)
    throw FileError(fmt::format("{} has {} components in {} and {} in {}", field, components, first.file.string(),
                                b.components(), second.file.string()));
  if (components > 1 || a.pieces() > 1 || b.pieces() > 1) {
    std::vector<std::pair<read::StoredDensity, read::StoredDensity>> each;
    for (std::size_t c = 0; c < components; ++c)
      each.emplace_back(read::StoredDensity(first.file, field, c), read::StoredDensity(second.file, field, c));
    return difference_of_pieces(each);
  }
  const std::vector<double>&x = a.values(0), &y = b.values(0);
  ErrorNorms norms = gaussdrift::compare(x, y);
  if (std::isnan(norms.linf)) norms.linf = x == y ? 0.0 : INFINITY;
  return norms;
}

/// Compares two outputs and tells about it; the row for JSON.
ordered_json compare_outputs(const WrittenOutput& a, const WrittenOutput& b, const std::string& field, bool json) {
  const bool at_other_time = a.time && b.time && !same_time(*a.time, *b.time);
  if (at_other_time)  // has it come back?
    note("warning: the times differ: {} is at t = {}, {} at t = {}\n", a.file.string(),
         base::told_apart(*a.time, *b.time), b.file.string(), base::told_apart(*b.time, *a.time));
  const ErrorNorms norms = difference(a, b, field);
  if (!json) say("{:<14} L1 {:.2e}  L2 {:.2e}  Linf {:.2e}\n", in_text(a.time), norms.l1, norms.l2, norms.linf);
  ordered_json row = {{"t", time_in_json(a.time)}, {"L1", norms.l1}, {"L2", norms.l2}, {"Linf", norms.linf}};
  if (at_other_time) row["t_second"] = time_in_json(b.time);
  return row;
}

ExitCode compare(const CompareOptions& options) {
  check_array(options.field);
  const auto a = outputs_of(options.first), b = outputs_of(options.second);
  const Partners partners = partners_of(a, b);
  if (partners.pairs.empty())
    throw FileError(
        fmt::format("{} and {} have no output time in common: the one has {}, the other {}; compare two of "
                    "their files to see how far apart they are all the same",
                    options.first.string(), options.second.string(), times_text(a), times_text(b)));
  ordered_json rows = ordered_json::array(), alone = ordered_json::array();
  tell_alone(a, partners.first_alone, options.second, alone);
  tell_alone(b, partners.second_alone, options.first, alone);
  double worst = 0;
  for (const auto& [i, j] : partners.pairs) {
    rows.push_back(compare_outputs(a[i], b[j], options.field, options.json));
    worst = std::max(worst, rows.back()["Linf"].get<double>());
  }
  const bool apart = options.tolerance >= 0 && !(worst <= options.tolerance);
  if (options.json)
    say("{}\n", laid_out({{"outputs", rows}, {"not_compared", alone}, {"largest", worst}, {"within", !apart}}));
  else
    say("largest difference {:.2e}, relative to {}{}\n", worst, options.second.string(),
        options.tolerance < 0 ? ""
        : apart               ? fmt::format(": more than {:g}", options.tolerance)
                              : fmt::format(": within {:g}", options.tolerance));
  return apart ? ExitCode::check : ExitCode::ok;
}

}  // namespace

Verb compare_verb() {
  return make_verb<CompareOptions>("compare", "compare two results: norms of the difference, relative to the second",
                                   declare, compare);
}

}  // namespace gaussdrift::cli
