#include "reproduce/figures.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <string_view>
#include <utility>

#include "base/stopwatch.hpp"
#include "gaussdrift/error.hpp"
#include "gaussdrift/read_case.hpp"
#include "gaussdrift/simulation.hpp"
#include "input/examples.hpp"
#include "render/chart.hpp"
#include "render/picture.hpp"
#include "render/styles.hpp"
#include "reproduce/box_figures.hpp"
#include "reproduce/fgtd.hpp"
#include "reproduce/point_sets.hpp"
#include "write/result_folder.hpp"

namespace gaussdrift::reproduce {

namespace {

/// Keeps the density of every output.
class Keep : public Observer {
 public:
  explicit Keep(std::vector<std::pair<double, DensityGrid>>& frames) : frames_(frames) {}
  std::string name() const override { return "keep"; }
  void frame(const Frame& frame) override { frames_.emplace_back(frame.time, *frame.density); }

 private:
  std::vector<std::pair<double, DensityGrid>>& frames_;
};

/// The densities of a built-in case at its output times, all with 300 x 300 particles and c = 2 unless overridden, on
/// 200 x 200 points [Sch06, 5.3].
std::vector<std::pair<double, DensityGrid>> densities(const std::string& name,
                                                      const std::vector<std::string>& overrides, int threads) {
  const auto& files = input::example_files();
  const auto file = std::find_if(files.begin(), files.end(), [&](const auto& f) { return f.name == name + ".toml"; });
  if (file == files.end()) throw Error(ExitCode::internal, "there is no built-in case " + name);
  Case spec = parse_case(std::string(file->bytes), name + ".toml", overrides, threads).spec;
  spec.checks.clear();  // nothing is compared, so no exact density is needed
  spec.reference = {};
  std::vector<std::pair<double, DensityGrid>> frames;
  Simulation simulation(spec, threads);
  simulation.observe(std::make_unique<Keep>(frames));
  simulation.run();
  return frames;
}

// As the thesis shows densities: heights in perspective, or contour lines from above and from the side.
const render::Style& heights() { return render::find_style("surface"); }
const render::Style& lines() { return render::find_style("contour"); }

/// All that a figure is made from.
struct Maker {
  const FiguresOptions& options;
  std::vector<Figure>& made;
  write::ResultFolder& place;

  std::filesystem::path file(const std::string& number) const { return place.claim("figure_" + number + ".png"); }
  void add(const std::string& number, const std::string& caption, const base::Stopwatch& watch) const {
    made.push_back({number, caption, file(number), watch.seconds()});
  }
  /// As a PNG, and beside it in the other formats of charts.
  void chart(const std::string& number, const render::Chart& chart) const {
    std::filesystem::path stem = file(number);
    for (const std::string_view ending : render::chart_endings()) place.claim("figure_" + number + std::string(ending));
    write_chart(chart, stem.replace_extension());
  }
  void field(const std::string& number, const std::string& caption, const std::string& title,
             const render::Style& style, const std::pair<double, DensityGrid>& frame, const base::Stopwatch& watch,
             bool from_below = false) const {
    draw(style, frame.second,
         {.title = title, .time = frame.first, .from_below = from_below, .range_min = 0, .range_max = 1}, file(number));
    add(number, caption, watch);
  }
};

// Lemma 3.5.1 with d = 2: operations a point of fgtd for N = M, and in all for N and M.
double operations_a_point(double p, double n) { return p * p + (2 * n + 1) * (2 * n + 1) * p * p; }
double operations(double p, double n, double sources, double targets) {
  return p * p * sources + (2 * n + 1) * (2 * n + 1) * p * p * targets;
}

void hermite_polynomials(const Maker& make) {
  const base::Stopwatch watch;
  constexpr int most = 4, intervals = 200;
  std::vector<render::ChartSeries> curves;
  for (int n = 0; n <= most; ++n)
    curves.push_back({.name = fmt::format("n = {}", n), .look = render::ChartSeries::Look::line});
  for (int i = 0; i <= intervals; ++i) {
    const double t = -2 + 4.0 * i / intervals;
    double before = 0, value = 1;  // H_{n+1} = 2 t H_n - 2 n H_{n-1}
    for (int n = 0; n <= most; ++n) {
      curves[static_cast<std::size_t>(n)].points.push_back({t, value});
      before = std::exchange(value, 2 * t * value - 2 * n * before);
    }
  }
  make.chart("2.1", {.title = "Hermite polynomials",
                     .x = render::ChartAxis{.name = "t"},
                     .y = render::ChartAxis{.name = "H_n(t)", .range = {-50, 120}},
                     .series = std::move(curves)});
  make.add("2.1", "the first five Hermite polynomials", watch);
}

void gaussians(const Maker& make) {
  constexpr int intervals = 200;
  const auto place = [](int i, int of) { return -3 + 6.0 * i / of; };
  {
    const base::Stopwatch watch;
    std::vector<render::ChartSeries> curves;
    for (const double sigma : {0.5, 1.0, 2.0}) {
      render::ChartSeries curve{.name = fmt::format("σ = {}", sigma), .look = render::ChartSeries::Look::line};
      for (int i = 0; i <= intervals; ++i) {
        const double x = place(i, intervals);
        curve.points.push_back({x, std::exp(-sigma * x * x)});
      }
      curves.push_back(std::move(curve));
    }
    make.chart("3.1a", {.title = "Gaussians exp(-σ x²)",
                        .x = render::ChartAxis{.name = "x"},
                        .y = render::ChartAxis{.name = "value"},
                        .series = std::move(curves)});
    make.add("3.1a", "three Gaussians in one dimension", watch);
  }
  const base::Stopwatch watch;
  constexpr int points = 121;
  DensityGrid bell;
  bell.lattice.dimension = 2;
  bell.lattice.origin = {-3, -3, 0};
  bell.lattice.spacing = 6.0 / (points - 1);
  bell.lattice.points = {points, points, 1};
  for (int j = 0; j < points; ++j)
    for (int i = 0; i < points; ++i) {
      const double x = place(i, points - 1), y = place(j, points - 1);
      bell.rho.push_back(std::exp(-x * x - y * y));
    }
  draw(heights(), bell, {.title = "A Gaussian, σ = 1", .quantity = "value", .time = {}, .range_min = 0, .range_max = 1},
       make.file("3.1b"));
  make.add("3.1b", "a Gaussian in two dimensions, sigma = 1", watch);
}

void boxes(const Maker& make, const std::string& number, const std::string& caption,
           void (*draw)(const std::filesystem::path&)) {
  const base::Stopwatch watch;
  draw(make.file(number));
  make.add(number, caption, watch);
}

void box(const Maker& make) {
  boxes(make, "3.2", "a box with its corners, its centre and a point in it", draw_box_with_its_corners);
}

void subboxes(const Maker& make) {
  boxes(make, "3.3", "a bounding box cut into 35 subboxes, their numbers and indices", draw_numbered_boxes);
}

void neighbours(const Maker& make) {
  boxes(make, "3.4", "the neighbour boxes of a box for n = 0, 1, 2 and n >= 3, by Algorithm 3.4", draw_neighbours);
}

void recursion(const Maker& make) {
  boxes(make, "3.5", "the order in which Algorithm 3.5 finds 16 neighbours, n = 2", draw_recursion);
}

void points_of_tests(const Maker& make) {
  constexpr std::size_t count = 500;
  const auto chart = [&](const std::string& number, const std::string& name, const fgtd::Points<2>& points) {
    const base::Stopwatch watch;
    render::ChartSeries marks{.name = "", .look = render::ChartSeries::Look::marks};
    for (Eigen::Index i = 0; i < points.cols(); ++i) marks.points.push_back({points(0, i), points(1, i)});
    make.chart(number, {.title = fmt::format("{} {} points", count, name),
                        .x = render::ChartAxis{.name = "x", .range = {0, 1}},
                        .y = render::ChartAxis{.name = "y", .range = {0, 1}},
                        .series = {marks},
                        .width = 1000,
                        .height = 1000});
    make.add(number, fmt::format("{} {} points in the unit square", count, name), watch);
  };
  constexpr std::uint64_t seed = 1;
  chart("4.1a", "random", random_points<2>(count, seed));
  chart("4.1b", "Halton", halton_points<2>(count));
}

void cost_of_parameters(const Maker& make) {
  const base::Stopwatch watch;
  constexpr int most_p = 20, most_n = 10;
  DensityGrid cost;
  cost.lattice.dimension = 2;
  cost.lattice.origin = {0, 0, 0};
  cost.lattice.spacing = 1;
  cost.lattice.points = {most_p + 1, most_n + 1, 1};
  for (int n = 0; n <= most_n; ++n)
    for (int p = 0; p <= most_p; ++p) cost.rho.push_back(operations_a_point(p, n) / 1e3);
  draw(heights(), cost,
       {.title = "Cost of the fast Gauss transform, p² + (2n+1)² p²",
        .quantity = "thousand operations a point",
        .axes = {"terms p", "neighbour boxes n"},
        .time = {},
        .range_min = 0,
        .range_max = 200},
       make.file("3.6"));
  make.add("3.6", "cost over the number of terms p and of neighbour boxes n, d = 2, N = M", watch);
}

void break_even(const Maker& make) {
  const base::Stopwatch watch;
  constexpr double sources = 1e4, p = 8, n = 2;
  render::ChartSeries fast{.name = "fast Gauss transform, p = 8, n = 2", .look = render::ChartSeries::Look::line},
      pairs{.name = "pair by pair", .look = render::ChartSeries::Look::line};
  for (int targets = 0; targets <= 200; targets += 10) {
    fast.points.push_back({double(targets), operations(p, n, sources, targets) / 1e6});
    pairs.points.push_back({double(targets), sources * targets / 1e6});
  }
  const double even = p * p * sources / (sources - (2 * n + 1) * (2 * n + 1) * p * p);
  make.chart("3.7",
             {.title = "Cost with 10 000 sources, d = 2",
              .x = render::ChartAxis{.name = "evaluations M"},
              .y = render::ChartAxis{.name = "million operations"},
              .series = {fast, pairs},
              .conclusion = fmt::format("The fast transform pays from {:.0f} evaluations on.", std::ceil(even))});
  make.add("3.7", "cost of both methods over the number of evaluations, N = 10 000", watch);
}

void performance(const Maker& make) {
  const base::Stopwatch watch;
  FgtdOptions options;
  if (make.options.full) options = FgtdOptions::everything();
  options.table = "4.2";
  const Table table = reproduce_fgtd(options).tables.front();
  using Look = render::ChartSeries::Look;
  struct Curve {
    std::string column, name;
  };
  render::Chart chart{.title = "Seconds over the number of points, N = M, d = 3",
                      .x = render::ChartAxis{.name = "points N", .logarithmic = true},
                      .y = render::ChartAxis{.name = "seconds", .logarithmic = true},
                      .series = {}};
  double slowest = 0, fastest = 0;
  for (const Curve& curve : {Curve{"direct", "pair by pair"}, Curve{"p=8 nu=2 seconds", "p = 8, ν = 2"},
                             Curve{"p=9 nu=3 seconds", "p = 9, ν = 3"}}) {
    const auto column = std::find_if(table.columns.begin(), table.columns.end(),
                                     [&](const Column& c) { return c.name == curve.column; });
    if (column == table.columns.end()) throw Error(ExitCode::internal, "Table 4.2 has no column " + curve.column);
    const auto index = static_cast<std::size_t>(column - table.columns.begin());
    render::ChartSeries then{.name = "", .look = Look::dashed, .quiet = true}, now{.name = curve.name};
    if (chart.series.empty()) then.name = "the same in 2006";
    for (const Row& row : table.rows) {
      const double points = std::stod(row.name.substr(row.name.find('=') + 1));
      const Entry& entry = row.entries[index];
      if (entry.published) then.points.push_back({points, *entry.published});
      if (!entry.computed) continue;
      now.points.push_back({points, *entry.computed});
      if (points == 20'000) (curve.column == "direct" ? slowest : fastest) = *entry.computed;
    }
    chart.series.push_back(std::move(then));
    chart.series.push_back(std::move(now));
  }
  chart.conclusion = fmt::format(
      "The pairs cost N², the fast transform N: with 20 000 points {:.3g} s against {:.2g} s at an error of 1e-6.",
      slowest, fastest);
  chart.footer =
      "Schroeder 2006, Table 4.2: a 3.05 GHz Pentium 4; here method hermite with the same parameters on one thread.";
  make.chart("4.2", chart);
  make.add("4.2", "times of Table 4.2, printed (dashed) and measured; logarithmic axes here", watch);
}

void cone_of_widths(const Maker& make) {
  for (const auto& [letter, overlap] : {std::pair{"a", 2}, {"b", 20}}) {
    const base::Stopwatch watch;
    const auto frames = densities("rotating_cone", {fmt::format("particles.overlap={}", overlap), "output.times=[0]"},
                                  make.options.threads);
    make.field(fmt::format("5.1{}", letter), fmt::format("the cone at t = 0, c = {}", overlap),
               fmt::format("Cone, c = {}", overlap), heights(), frames.front(), watch);
  }
}

void turning_cone(const Maker& make) {
  const base::Stopwatch watch;
  const auto frames = densities("rotating_cone", {"output.times=[0, \"pi/2\"]"}, make.options.threads);
  make.field("5.2a", "the cone at t = 0", "Rotating cone", heights(), frames[0], watch);
  make.field("5.2b", "the cone at t = pi/2, a quarter of a turn", "Rotating cone", heights(), frames[1], watch);
}

void lines_of_the_cone(const Maker& make) {
  const base::Stopwatch watch;
  const double step = make.options.full ? 0.001 : 0.01;
  const auto frames =
      densities("rotating_cone", {"time.end=200*pi", "output.times=[\"200*pi\"]", fmt::format("time.step={}", step)},
                make.options.threads);
  make.field("5.3",
             fmt::format("contour lines of the cone after 100 turns, from above and from the side, steps of {}{}", step,
                         make.options.full ? "" : " (0.001 with --full; the difference is below 1e-7)"),
             "Cone after 100 turns", lines(), frames.front(), watch);
}

void disk_with_gap(const Maker& make) {
  const base::Stopwatch watch;
  const auto frames = densities("rotating_gap", {"output.times=[0, \"400*pi\"]"}, make.options.threads);
  make.field("5.4a", "the disk with a gap at t = 0", "Disk with a gap", heights(), frames.front(), watch);
  make.field("5.4b", "the disk after 200 turns, steps of 0.01", "Disk with a gap after 200 turns", heights(),
             frames.back(), watch);
  make.field("5.5", "its contour lines from below and from the side", "Disk with a gap after 200 turns", lines(),
             frames.back(), watch, true);
}

constexpr std::pair<std::string_view, void (*)(const Maker&)> makers[]{{"2.1", hermite_polynomials},
                                                                       {"3.1", gaussians},
                                                                       {"3.2", box},
                                                                       {"3.3", subboxes},
                                                                       {"3.4", neighbours},
                                                                       {"3.5", recursion},
                                                                       {"3.6", cost_of_parameters},
                                                                       {"3.7", break_even},
                                                                       {"4.1", points_of_tests},
                                                                       {"4.2", performance},
                                                                       {"5.1", cone_of_widths},
                                                                       {"5.2", turning_cone},
                                                                       {"5.3", lines_of_the_cone},
                                                                       {"5.4", disk_with_gap}};

}  // namespace

std::vector<std::string> figure_numbers() {
  std::vector<std::string> numbers;
  for (const auto& [number, make] : makers) numbers.emplace_back(number);
  numbers.emplace_back("5.5");  // made with 5.4
  return numbers;
}

std::vector<Figure> reproduce_figures(const FiguresOptions& options,
                                      const std::function<void(const std::string&)>& progress) {
  const auto numbers = figure_numbers();
  if (!options.figure.empty() && std::find(numbers.begin(), numbers.end(), options.figure) == numbers.end())
    throw CommandLineError(
        fmt::format("there is no figure {} to reproduce; there are: {}", options.figure, fmt::join(numbers, ", ")));
  render::check_available();
  const std::string wanted = options.figure == "5.5" ? "5.4" : options.figure;
  std::vector<Figure> made;
  // Figures of other calls stay.
  write::ResultFolder place(options.folder, "figures", write::ResultFolder::Earlier::join);
  for (const auto& [number, make] : makers) {
    if (!wanted.empty() && wanted != number) continue;
    if (progress) progress(fmt::format("Figure {}", number));
    make({options, made, place});
  }
  place.complete();
  return made;
}

std::string to_text(const std::vector<Figure>& figures) {
  std::string text = "figures of Schroeder 2006, computed and drawn again\n";
  for (const Figure& figure : figures)
    text += fmt::format("  {:<5} {}  {}  ({:.1f} s)\n", figure.number, figure.file.string(), figure.caption,
                        figure.seconds);
  return text;
}

std::string to_json(const std::vector<Figure>& figures) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const Figure& figure : figures)
    list.push_back({{"figure", figure.number},
                    {"file", figure.file.string()},
                    {"caption", figure.caption},
                    {"seconds", figure.seconds}});
  return list.dump(2) + "\n";
}

}  // namespace gaussdrift::reproduce
