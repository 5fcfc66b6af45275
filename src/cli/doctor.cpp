// gaussdrift doctor: does everything work on this machine?
#include <fmt/format.h>

#include <Eigen/Core>
#include <cmath>
#include <fgtd/fgtd.hpp>
#include <functional>
#include <nlohmann/json.hpp>
#include <sstream>

#include "base/parallel.hpp"
#include "cli/terminal.hpp"
#include "cli/verbs.hpp"
#include "core/dispatch.hpp"
#include "mpi/ranks.hpp"
#include "read/grid_file.hpp"
#include "read/netcdf/netcdf_file.hpp"
#include "render/styles.hpp"
#include "rows/rows.hpp"
#include "write/vtk_files.hpp"

namespace gaussdrift::cli {

namespace fs = std::filesystem;

namespace {

struct DoctorOptions {
  bool json = false;
};

struct Finding {
  std::string what, found;
  bool well = true;
};

/// sum_j exp(-sigma |y - x_j|^2) over the corners of a square, by every method: 4 exp(-2 sigma) at its centre.
Finding check_sum() {
  fgtd::Points<2> corners(2, 4), centre(2, 1);
  corners << -1, 1, -1, 1, -1, -1, 1, 1;
  centre << 0, 0;
  const double exact = 4 * std::exp(-2 * 0.7);
  double worst = 0;
  for (const fgtd::Method method : fgtd::methods())
    worst = std::max(
        worst, std::abs(fgtd::Plan<2>(corners, Eigen::MatrixXd::Ones(4, 1), 0.7, {.tolerance = 1e-12, .method = method})
                            .evaluate(centre)(0, 0) -
                        exact));
  return {"Gauss sum", fmt::format("{} methods agree with 4 exp(-2 sigma) to {:.0e}", fgtd::methods().size(), worst),
          worst < 1e-11};
}

DensityGrid hill() {
  DensityGrid density{make_lattice(2, {-1, -1, 0}, {1, 1, 0}, 41), {}};
  for (std::size_t i = 0; i < density.lattice.size(); ++i) {
    const double x = density.lattice.coordinate(0, i % 41), y = density.lattice.coordinate(1, i / 41);
    density.rho.push_back(std::exp(-4 * (x * x + y * y)));
  }
  return density;
}

Finding check_picture(const fs::path& folder) {
  if (const std::string reason = render::unavailable_reason(); !reason.empty()) return {"picture", reason, false};
  render::draw(render::default_style(2), hill(), {.width = 320, .height = 240}, folder / "picture.png");
  return {
      "picture",
      fmt::format("drawn off screen by {}, {} bytes", render::drawing_library(), fs::file_size(folder / "picture.png")),
      true};
}

Finding check_file(const fs::path& folder) {
  const DensityGrid density = hill();
  write::write_density(folder / "density.vti", density, 0, nullptr);
  const auto back = read::read_grid(folder / "density.vti", {.arrays = {"rho"}});
  return {"file", "a density written for ParaView reads back bit for bit", back->values.front() == density.rho};
}

ExitCode doctor(const DoctorOptions& options) {
  std::vector<Finding> findings;
  findings.push_back({"version", fmt::format("gaussdrift {}, {}", GAUSSDRIFT_VERSION, GAUSSDRIFT_COMPILER)});
  findings.push_back(
      {"libraries", fmt::format("Eigen {}.{}.{}, fmt {}.{}.{}", EIGEN_WORLD_VERSION, EIGEN_MAJOR_VERSION,
                                EIGEN_MINOR_VERSION, FMT_VERSION / 10000, FMT_VERSION / 100 % 100, FMT_VERSION % 100)});
  findings.push_back({"threads", std::to_string(base::resolve_threads(0))});
  const core::InstructionSet& vectors = core::fastest_instruction_set();
  findings.push_back(
      {"vectors",
       fmt::format("{}: {} numbers at once in the Gauss transform; sines and exponentials {}", vectors.name,
                   vectors.lanes,
                   rows::has_sleef() ? "by SLEEF" : "one at a time: built without SLEEF (Debian: libsleef-dev)")});
  findings.push_back({"ranks", mpi::library().empty() ? "one: built without MPI (Debian: libopenmpi-dev)"
                                                      : fmt::format("several, by {}", mpi::library())});
  findings.push_back({"NetCDF", read::netcdf_library().empty()
                                    ? "not read: built without it, or the library is gone (Debian: libnetcdf-dev)"
                                    : fmt::format("read, by {}", read::netcdf_library())});
  std::string pattern = (fs::temp_directory_path() / "gaussdrift-doctor.XXXXXX").string();
  if (!mkdtemp(pattern.data()))
    throw FileError(fmt::format("no folder can be made in {}", fs::temp_directory_path().string()));
  const fs::path folder = pattern;
  const auto check = [&](const char* what, const std::function<Finding()>& find) {
    try {
      findings.push_back(find());
    } catch (const std::exception& error) {
      findings.push_back({what, error.what(), false});
    }
  };
  check("Gauss sum", check_sum);
  check("picture", [&] { return check_picture(folder); });
  check("file", [&] { return check_file(folder); });
  std::error_code ignored;
  fs::remove_all(folder, ignored);
  bool well = true;
  auto document = nlohmann::ordered_json::object();
  for (const Finding& finding : findings) {
    well = well && finding.well;
    document[finding.what] = {{"found", finding.found}, {"well", finding.well}};
    if (!options.json) say("{:<10} {:<4} {}\n", finding.what, finding.well ? "ok" : "BAD", finding.found);
  }
  if (options.json) say("{}\n", document.dump(2));
  return well ? ExitCode::ok : ExitCode::check;
}

}  // namespace

Verb doctor_verb() {
  return make_verb<DoctorOptions>(
      "doctor", "try everything on this machine: a sum, a picture, a file",
      [](OptionList& options, DoctorOptions& given) { options.json(given.json); }, doctor);
}

}  // namespace gaussdrift::cli
