#include "reproduce/logkernel.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <random>

#include "base/repeated_time.hpp"
#include "base/stopwatch.hpp"
#include "blockmatrix/block_matrix.hpp"
#include "render/chart.hpp"
#include "render/picture.hpp"
#include "write/atomic_file.hpp"
#include "write/provenance.hpp"
#include "write/result_folder.hpp"

namespace gaussdrift::reproduce {

namespace {

constexpr int degrees = 6;  // n = 0 .. 5
constexpr int product_degree = 3;
constexpr std::size_t large_leaf = 16;

Eigen::VectorXd points_of(std::size_t count) {
  return Eigen::VectorXd::LinSpaced(static_cast<Eigen::Index>(count), 0, 1);
}

/// m_k = ln(k h), m_0 = 0.
Eigen::VectorXd first_column(const Eigen::VectorXd& points) {
  Eigen::VectorXd column(points.size());
  for (Eigen::Index k = 0; k < column.size(); ++k)
    column[k] = k == 0 ? 0 : blockmatrix::log_kernel(points[k], points[0]);
  return column;
}

/// Seconds of one call: the fastest of some lots of calls that fill five milliseconds each.
template <class Work>
double seconds_of(const Work& work) {
  work();
  const base::Stopwatch total;
  base::RepeatedTime time;
  do {
    const base::Stopwatch watch;
    int calls = 0;
    do {
      work();
      ++calls;
    } while (watch.seconds() < 0.005);
    time.add(watch.seconds() / calls);
  } while (total.seconds() < (time.repeatable() ? 0.05 : 0.2));
  return time.fastest();
}

LogKernelTimes time_products(std::size_t count, bool dense) {
  using blockmatrix::Bases;
  LogKernelTimes times{.points = count, .degree = product_degree, .dense = {}};
  const Eigen::VectorXd points = points_of(count), column = first_column(points);
  Eigen::VectorXd x(points.size()), y;
  std::mt19937 random(1);
  for (double& entry : x) entry = static_cast<double>(random()) * 0x1p-32;
  const blockmatrix::BlockMatrix blocks(blockmatrix::log_kernel, points, {.degree = product_degree});
  const blockmatrix::BlockMatrix shared(blockmatrix::log_kernel, points,
                                        {.degree = product_degree, .leaf_size = large_leaf, .bases = Bases::shared});
  const blockmatrix::ToeplitzMatrix fourier(column, column);
  times.blocks = seconds_of([&] { y = blocks * x; });
  times.shared = seconds_of([&] { y = shared * x; });
  times.fourier = seconds_of([&] { y = fourier * x; });
  times.difference = (blocks * x - y).cwiseAbs().maxCoeff() / y.cwiseAbs().maxCoeff();
  if (dense) {
    Eigen::MatrixXd matrix(points.size(), points.size());
    for (Eigen::Index j = 0; j < matrix.cols(); ++j)
      for (Eigen::Index i = 0; i < matrix.rows(); ++i) matrix(i, j) = column[std::abs(i - j)];
    times.dense = seconds_of([&] { y.noalias() = matrix * x; });
  }
  return times;
}

double squared_norm(const Eigen::VectorXd& column) {
  double sum = 0;
  for (Eigen::Index k = 1; k < column.size(); ++k)
    sum += 2 * static_cast<double>(column.size() - k) * column[k] * column[k];
  return sum;
}

std::string storage_csv(const LogKernelReproduction& result) {
  std::string text = "N,n,blocks,low_rank_blocks,doubles,doubles_shared_bases,doubles_leaf_16,doubles_both\n";
  for (const LogKernelStorage& row : result.storage)
    text += fmt::format("{},{},{},{},{},{},{},{}\n", row.points, row.degree, row.blocks, row.low_rank, row.doubles,
                        row.shared, row.leaf, row.both);
  return text;
}

std::string error_csv(const LogKernelReproduction& result) {
  std::string text = "N,n,squared_frobenius_error,squared_frobenius_norm\n";
  for (const LogKernelError& row : result.errors)
    text += fmt::format("{},{},{},{}\n", row.points, row.degree, row.squared, row.norm);
  return text;
}

std::string times_csv(const LogKernelReproduction& result) {
  std::string text = "N,n,seconds_dense,seconds_blocks,seconds_blocks_shared_leaf_16,seconds_fft\n";
  for (const LogKernelTimes& row : result.times)
    text += fmt::format("{},{},{},{},{},{}\n", row.points, row.degree, row.dense ? fmt::format("{}", *row.dense) : "",
                        row.blocks, row.shared, row.fourier);
  return text;
}

render::Chart storage_chart(const LogKernelReproduction& result) {
  render::Chart chart{.title = "Storage of ln|x - y| in blocks",
                      .x = render::ChartAxis{.name = "points N", .logarithmic = true},
                      .y = render::ChartAxis{.name = "numbers kept", .logarithmic = true},
                      .series = {},
                      .footer = write::made_by()};
  render::ChartSeries full{.name = "all entries, N²", .look = render::ChartSeries::Look::dashed};
  for (const LogKernelStorage& row : result.storage)
    if (row.degree == 0)
      full.points.push_back({static_cast<double>(row.points), std::pow(static_cast<double>(row.points), 2)});
  chart.series.push_back(full);
  for (int n = degrees - 1; n >= 0; --n) {
    render::ChartSeries series{.name = fmt::format("n = {}", n)};
    for (const LogKernelStorage& row : result.storage)
      if (row.degree == n) series.points.push_back({static_cast<double>(row.points), static_cast<double>(row.doubles)});
    chart.series.push_back(series);
  }
  const LogKernelStorage& last = result.storage.back();
  chart.conclusion = fmt::format(
      "{} points, n = {}: {} numbers, {:.0f} times fewer than all entries; {} with shared bases and exact blocks of 16",
      last.points, last.degree, last.doubles,
      std::pow(static_cast<double>(last.points), 2) / static_cast<double>(last.doubles), last.both);
  return chart;
}

render::Chart error_chart(const LogKernelReproduction& result) {
  render::Chart chart{.title = "Error of ln|x - y| in blocks",
                      .x = render::ChartAxis{.name = "degree n", .range = {-0.2, degrees - 0.8}},
                      .y = render::ChartAxis{.name = "squared Frobenius error", .logarithmic = true},
                      .series = {},
                      .footer = write::made_by()};
  std::vector<std::size_t> sizes;
  for (const LogKernelError& row : result.errors)
    if (row.degree == 0) sizes.push_back(row.points);
  for (auto size = sizes.rbegin(); size != sizes.rend(); ++size) {
    render::ChartSeries series{.name = fmt::format("N = {}", *size)};
    for (const LogKernelError& row : result.errors)
      if (row.points == *size) series.points.push_back({static_cast<double>(row.degree), row.squared});
    chart.series.push_back(series);
  }
  const LogKernelError &first = result.errors[result.errors.size() - degrees], &last = result.errors.back();
  chart.conclusion = fmt::format("each further degree makes the error (not squared) {:.0f} times smaller",
                                 std::pow(first.squared / last.squared, 0.5 / (degrees - 1)));
  return chart;
}

}  // namespace

LogKernelReproduction reproduce_logkernel(const LogKernelOptions& options,
                                          const std::function<void(const std::string&)>& progress) {
  const base::Stopwatch watch;
  const auto tell = [&](const std::string& what) {
    if (progress) progress(what);
  };
  using blockmatrix::Bases;
  LogKernelReproduction result;
  std::optional<write::ResultFolder> place;
  if (!options.folder.empty()) place.emplace(options.folder, "logkernel", write::ResultFolder::Earlier::replace);
  tell("storage");
  for (int i = 2; i <= options.largest_storage; ++i) {
    const std::size_t count = std::size_t{1} << i;
    const auto blocks = blockmatrix::block_list(points_of(count)),
               coarse = blockmatrix::block_list(points_of(count), large_leaf);
    const auto low_rank = static_cast<std::size_t>(
        std::count_if(blocks.begin(), blocks.end(), [](const blockmatrix::Block& block) { return block.low_rank; }));
    for (int n = 0; n < degrees; ++n)
      result.storage.push_back({count, n, blocks.size(), low_rank, blockmatrix::storage(blocks, n),
                                blockmatrix::storage(blocks, n, Bases::shared), blockmatrix::storage(coarse, n),
                                blockmatrix::storage(coarse, n, Bases::shared)});
  }
  tell("errors");
  for (int i = 6; i <= options.largest_error; ++i) {
    const Eigen::VectorXd points = points_of(std::size_t{1} << i);
    for (int n = 0; n < degrees; ++n)
      result.errors.push_back({static_cast<std::size_t>(points.size()), n,
                               blockmatrix::BlockMatrix(blockmatrix::log_kernel, points, {.degree = n}).squared_error(),
                               squared_norm(first_column(points))});
  }
  for (int n = 0; n < degrees; ++n) {
    const Eigen::VectorXd points = points_of(256);
    const Eigen::MatrixXd found =
        blockmatrix::interpolate_kernel(blockmatrix::smooth_kernel, n, points, points).dense();
    const Eigen::VectorXd e = points.array().exp();
    result.smooth.push_back({n, (found - e * e.transpose()).norm() / 256});
  }
  for (int i = 10; i <= options.largest_product; ++i) {
    tell(fmt::format("products, N = {}", 1 << i));
    result.times.push_back(time_products(std::size_t{1} << i, i <= options.largest_dense));
  }
  if (!options.folder.empty()) {
    tell("plots");
    const auto path = [&](const std::string& name) { return result.files.emplace_back(place->claim(name)); };
    write::write_text(path("storage.csv"), storage_csv(result));
    write::write_text(path("error.csv"), error_csv(result));
    write::write_text(path("times.csv"), times_csv(result));
    for (const auto& [name, chart] : {std::pair{"storage", storage_chart(result)}, {"error", error_chart(result)}}) {
      for (const std::string_view ending : render::chart_endings()) path(std::string(name) + std::string(ending));
      render::write_chart(chart, options.folder / name);
    }
    place->has_result();
    place->complete();
  }
  result.seconds = watch.seconds();
  return result;
}

std::string to_text(const LogKernelReproduction& result) {
  std::string text = "Melenk, project 6: ln|x_i - x_j| in blocks, exact or of rank n + 1\n\n";
  text += "exercise 6a: how many numbers are kept\n       N  blocks (low rank)";
  for (int n = 0; n < degrees; ++n) text += fmt::format("{:>10}", fmt::format("n = {}", n));
  text += "   n = 5: shared bases   leaf 16      both         N^2\n";
  for (std::size_t i = 0; i + degrees <= result.storage.size(); i += degrees) {
    const LogKernelStorage& row = result.storage[i];
    text += fmt::format("{:8} {:7} {:>9}", row.points, row.blocks, fmt::format("({})", row.low_rank));
    for (int n = 0; n < degrees; ++n)
      text += fmt::format("{:10}", result.storage[i + static_cast<std::size_t>(n)].doubles);
    const LogKernelStorage& last = result.storage[i + degrees - 1];
    text += fmt::format("{:22}{:10}{:10}{:12}\n", last.shared, last.leaf, last.both, row.points * row.points);
  }
  text += "\nexercise 6b: squared error in the Frobenius norm\n       N";
  for (int n = 0; n < degrees; ++n) text += fmt::format("{:>10}", fmt::format("n = {}", n));
  text += "   squared norm\n";
  for (std::size_t i = 0; i + degrees <= result.errors.size(); i += degrees) {
    text += fmt::format("{:8}", result.errors[i].points);
    for (int n = 0; n < degrees; ++n)
      text += fmt::format("{:10.2e}", result.errors[i + static_cast<std::size_t>(n)].squared);
    text += fmt::format("{:15.4g}\n", result.errors[i].norm);
  }
  text += "\nexercise 3: e^(x + y) as one block of rank n + 1, error in the Frobenius norm over N\n        ";
  for (const SmoothKernelError& row : result.smooth) text += fmt::format("{:10.2e}", row.error);
  text +=
      "\n\nexercise 7: seconds of a product, one thread\n       N     dense   blocks n = 3   shared, leaf 16      "
      "   FFT   dense/FFT   blocks/FFT   difference\n";
  for (const LogKernelTimes& row : result.times)
    text += fmt::format("{:8}{:>10}{:15.2e}{:18.2e}{:13.2e}{:>12}{:13.0f}{:13.1e}\n", row.points,
                        row.dense ? fmt::format("{:.2e}", *row.dense) : "-", row.blocks, row.shared, row.fourier,
                        row.dense ? fmt::format("{:.0f}", *row.dense / row.fourier) : "-", row.blocks / row.fourier,
                        row.difference);
  text += "\n";
  for (const auto& file : result.files) text += fmt::format("wrote  {}\n", file.string());
  return text + fmt::format("{:.1f} s\n", result.seconds);
}

std::string to_json(const LogKernelReproduction& result) {
  using Json = nlohmann::ordered_json;
  Json storage = Json::array(), errors = Json::array(), times = Json::array(), smooth = Json::array(),
       files = Json::array();
  for (const LogKernelStorage& row : result.storage)
    storage.push_back({{"N", row.points},
                       {"n", row.degree},
                       {"blocks", row.blocks},
                       {"low_rank_blocks", row.low_rank},
                       {"doubles", row.doubles},
                       {"doubles_shared_bases", row.shared},
                       {"doubles_leaf_16", row.leaf},
                       {"doubles_both", row.both}});
  for (const LogKernelError& row : result.errors)
    errors.push_back({{"N", row.points},
                      {"n", row.degree},
                      {"squared_frobenius_error", row.squared},
                      {"squared_frobenius_norm", row.norm}});
  for (const LogKernelTimes& row : result.times)
    times.push_back({{"N", row.points},
                     {"n", row.degree},
                     {"seconds_dense", row.dense ? Json(*row.dense) : Json()},
                     {"seconds_blocks", row.blocks},
                     {"seconds_blocks_shared_leaf_16", row.shared},
                     {"seconds_fft", row.fourier},
                     {"difference", row.difference}});
  for (const SmoothKernelError& row : result.smooth) smooth.push_back({{"n", row.degree}, {"error", row.error}});
  for (const auto& file : result.files) files.push_back(file.string());
  const Json document{{"source", "Melenk, project 6"},
                      {"storage", storage},
                      {"errors", errors},
                      {"smooth", smooth},
                      {"times", times},
                      {"files", files},
                      {"seconds", result.seconds}};
  return document.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

}  // namespace gaussdrift::reproduce
