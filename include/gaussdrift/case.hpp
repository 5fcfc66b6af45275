// A case: everything that one run needs, as plain validated data. `input` reads it from a file, `sim` runs it.
// Numbers are in the units of the case; expressions keep their text because fields compile them again for each thread.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace gaussdrift {

struct GridData;       // field/grid_data.hpp
struct GaussianModel;  // field/gaussian_velocity.hpp

/// Named constants of `[params]`, in file order.
using Params = std::vector<std::pair<std::string, double>>;

/// Parameters of a named formula: one number, or a point as one number a dimension.
using Arguments = std::vector<std::pair<std::string, std::vector<double>>>;

struct Domain {
  int dimension = 2;            // 2 or 3
  std::array<double, 3> min{};  // entries beyond the dimension are 0
  std::array<double, 3> max{};
};

// --- velocity ---------------------------------------------------------------------------------------------------

/// u = [...]: one expression a component in x, y, z, t and the params.
struct ExpressionVelocity {
  std::vector<std::string> components;
};
/// streamfunction = "...": psi in x, y, t and the params; u = (d psi/dy, -d psi/dx), in 2D.
struct StreamfunctionVelocity {
  std::string psi;
};
/// field = "...": a named field (docs/cases.md gives the formulas) with all of its parameters.
struct NamedVelocity {
  std::string field;
  Arguments arguments;
};
/// file = "...": data on a grid (docs/cases.md), already read.
struct FileVelocity {
  std::filesystem::path file;       // absolute
  std::vector<std::string> arrays;  // as written: one, or one a component; empty: the only one
  std::string interpolation, outside, missing;
  std::optional<double> missing_value;
  std::shared_ptr<const GridData> data;
};
/// gaussians = "...": divergence-free Gaussians at the points of a table, already read and fitted.
struct GaussianVelocitySpec {
  std::filesystem::path file;  // absolute
  std::string kind;            // of the numbers in it: "velocity", "vorticity", ...
  double residual = 0, regularisation = 0, tolerance = 0;
  std::shared_ptr<const GaussianModel> model;
};
using VelocitySpec =
    std::variant<ExpressionVelocity, StreamfunctionVelocity, NamedVelocity, FileVelocity, GaussianVelocitySpec>;

// --- initial density --------------------------------------------------------------------------------------------

/// expression = "...": rho_0 in x, y, z and the params.
struct ExpressionDensity {
  std::string text;
};
/// shape = "...": a named shape (docs/cases.md gives the formulas) with all of its parameters.
struct ShapeDensity {
  std::string shape;
  Arguments arguments;
};
/// file = "...": data on a grid, already read.
struct FileDensity {
  std::filesystem::path file;       // absolute
  std::vector<std::string> arrays;  // as written: one; empty: the only one
  std::string interpolation, outside, missing;
  std::optional<double> missing_value;
  std::shared_ptr<const GridData> data;
};
using DensitySpec = std::variant<ExpressionDensity, ShapeDensity, FileDensity>;

// --- discretisation ---------------------------------------------------------------------------------------------

struct ParticleSpec {
  int per_axis = 0;               // n_g on the longest axis
  double overlap = 2;             // c: eps = c h
  std::string cutoff = "gauss2";  // gauss2 | gauss4 | gauss6 | gauss8 | two-gauss
  double width_ratio = 2;         // a of two-gauss: the second width is a eps
  double threshold = 1e-12;       // part of the largest weight below which a lattice point has no particle
};

struct TimeSpec {
  double end = 0;
  double step = 0;             // tau; the largest step where the method chooses its own, 0: none is
  double tolerance = 1e-8;     // of one step, where the method chooses it; relative to the longest side of the domain
  std::string method = "rk4";  // name of a tableau
};

struct EvaluateSpec {
  int per_axis = 200;           // n_ge on the longest axis
  double spacing = 0;           // of the points on all axes; 0: per_axis says it
  double tolerance = 1e-8;      // of the Gauss transform, relative to max |rho| at that output
  std::string method = "auto";  // auto, or a method of fgtd by name
};

struct OutputSpec {
  enum class Vtk { density, particles };
  enum class Image { surface, contour, heatmap, slices, projection, isosurface, error };
  std::vector<double> times;  // ascending, 0 <= t <= end
  std::vector<Vtk> vtk{Vtk::density, Vtk::particles};
  std::vector<Image> images{Image::surface};
  bool report = true;  // report.html, report.json, summary.png
};

// --- what the results are compared with -------------------------------------------------------------------------

struct ReferenceSpec {
  enum class Kind { characteristics, exact, none };
  Kind kind = Kind::none;
  std::string rho;              // exact: an expression in x, y, z, t and the params
  std::optional<int> points{};  // most points of the grid that are compared; empty: chosen (sim/simulation.hpp)
};

/// A bound on a number of the outputs. The norms of the error are relative to those of the exact density at the same
/// time, the mass to that at the start.
struct CheckSpec {
  enum class Quantity { linf, l1, l2, mass };
  Quantity what = Quantity::linf;
  std::optional<double> max{}, min{};  // at least one of them
  std::optional<double> at{};          // one of the output times; none: all of them
};

// --- effects ----------------------------------------------------------------------------------------------------

/// alpha' = -rate alpha along the path.
struct ReactionSpec {
  std::string rate;  // expression in x, y, z, t and the params
};

/// d_t rho + div(rho u) = coefficient Laplacian rho.
struct DiffusionSpec {
  enum class Method { core_spreading, particle_exchange };
  double coefficient = 0;  // D
  Method method = Method::core_spreading;
  double tolerance = 1e-6;  // of particle_exchange: part of the largest density above which a particle has a halo
};

/// Weights go back to a fresh lattice.
struct RemeshSpec {
  int every = 0;         // steps between two; 0: as `stretch` says
  double stretch = 1.5;  // whenever neighbours are farther apart than so many spacings
  std::string kernel = "gauss8";
  double tolerance = 1e-9;  // part of the largest weight below which a node is left out
};

/// X' += mobility E(X), E the field of all particles.
struct ChargeSpec {
  double mobility = 1;
  std::string density{};    // of charge at the start, an expression in x, y, z and the params; empty: the weights
  double tolerance = 1e-6;  // of E, relative to the sum of all fields' sizes
};

/// X' += the velocity of all particles as vortex blobs.
struct VortexSpec {
  double tolerance = 1e-6;  // of the velocity, relative to the sum of all velocities' sizes
};

/// The effects that a case names; what is absent is not constructed.
struct EffectsSpec {
  std::optional<ReactionSpec> reaction;
  std::optional<DiffusionSpec> diffusion;
  std::optional<ChargeSpec> charge;
  std::optional<VortexSpec> vortex;
  std::optional<RemeshSpec> remesh;

  /// Particles move each other.
  bool drifts() const { return charge || vortex; }
};

/// How accurate it has to be, and whether a run tells its errors apart by cause.
struct AccuracySpec {
  enum class Budget { automatic, measured, none };  // automatic: measured where that costs a small part of the run
  Budget budget = Budget::automatic;
  std::optional<double>
      target{};  // largest error at the last output, relative to max |rho|; settings are chosen for it
};

struct Case {
  std::string name;            // stem of the file: names the output folder
  std::filesystem::path file;  // where it came from; empty for a case built in memory
  std::string source;          // text of that file
  std::string title;
  std::string cite;
  Params params;
  Domain domain;
  std::vector<VelocitySpec> velocity;  // the fields add up
  std::vector<DensitySpec> density;    // the densities add up
  ParticleSpec particles;
  TimeSpec time;
  EvaluateSpec evaluate;
  OutputSpec output;
  EffectsSpec effects;
  ReferenceSpec reference;
  AccuracySpec accuracy;
  std::vector<CheckSpec> checks;
};

}  // namespace gaussdrift
