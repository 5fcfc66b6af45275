/// @file
/// A case: everything that one run needs, as plain validated data.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "gaussdrift/pictures.hpp"

/// The simulator: smoothed particles in a velocity field. Numbers are in the units of the case. Expressions keep their
/// text, because every thread compiles its own. docs/cases.md explains every key.
namespace gaussdrift {

struct GridData;       // field/gridded/grid_data.hpp
struct GaussianModel;  // field/gaussians/gaussian_velocity.hpp
struct SampleFit;      // field/samples/sample_fit.hpp

/// Named constants of `[params]`, in file order.
using Params = std::vector<std::pair<std::string, double>>;

/// Named numbers.
using Numbers = std::vector<std::pair<std::string, double>>;

/// Parameters of a named formula: one number, or a point as one number a dimension.
using Arguments = std::vector<std::pair<std::string, std::vector<double>>>;

/// What happens at an end of an axis of the domain.
enum class Edge {
  unbounded,  ///< nothing: particles go on beyond it
  periodic,   ///< what goes out here comes in at the other end
  open,       ///< particles that pass it leave the run and are counted
  closed      ///< nothing passes it
};

/// What happens to particles that reach land, where data on a grid have no values.
enum class AtCoast {
  refuse,  ///< the run ends with an error
  stop,    ///< they stay there
  slide,   ///< they move along it
  remove   ///< they leave the run and are counted
};

/// `[domain]`: the box on which the density is evaluated and particles start.
struct Domain {
  int dimension = 2;            ///< 2 or 3
  std::array<double, 3> min{};  ///< lower corner; entries beyond the dimension are 0
  std::array<double, 3> max{};  ///< upper corner, above `min` on every axis
  /// The lower and the upper end of every axis. Either both or none of them are periodic.
  std::array<std::array<Edge, 2>, 3> edges{};
  AtCoast coast = AtCoast::refuse;  ///< what happens to particles that reach land
  /// Radius of the sphere on which x is the longitude and y the latitude, both in degrees. Velocities are then lengths per
  /// time, and densities are per area. 0: x, y and z are lengths.
  double sphere = 0;

  /// True if places are longitudes and latitudes.
  bool on_sphere() const { return sphere > 0; }
  /// True if the case says of edges or of land what happens there: then outputs tell the mass inside.
  bool counts_inside() const { return has_edges() || coast != AtCoast::refuse; }
  /// True if the case says of any end what happens there.
  bool has_edges() const { return edges != std::array<std::array<Edge, 2>, 3>{}; }
  /// True if some end is like that.
  bool has(Edge edge) const {
    return std::any_of(edges.begin(), edges.end(),
                       [edge](const auto& ends) { return std::find(ends.begin(), ends.end(), edge) != ends.end(); });
  }
};

// --- velocity ---------------------------------------------------------------------------------------------------

/// u = [...]: one expression a component in x, y, z, t and the params.
struct ExpressionVelocitySpec {
  std::vector<std::string> components;  ///< one expression a dimension
};
/// streamfunction = "...": psi in x, y, t and the params; u = (d psi/dy, -d psi/dx), in 2D.
struct StreamfunctionVelocitySpec {
  std::string psi;  ///< the expression
};
/// field = "...": a named field (docs/cases.md gives the formulas) with all of its parameters.
struct NamedVelocitySpec {
  std::string field;    ///< its name
  Arguments arguments;  ///< all of its parameters
};
/// `time = { start = ..., unit = ... }`: how the times of data become those of the scene.
struct FileClock {
  std::string start;                     ///< a date of the data at which the scene begins; empty: see start_number
  std::optional<double> start_number{};  ///< the same as a time of the data
  std::string unit;                      ///< of the time of the scene: "h"; empty: see unit_number
  std::optional<double> unit_number{};   ///< how much of the data's time is 1 in the scene

  /// The same clock.
  bool operator==(const FileClock&) const = default;
};
/// file = "...": data on a grid (docs/cases.md), already read.
struct GridFileSpec {
  std::filesystem::path file;            ///< absolute; its name may be a pattern
  std::vector<std::string> arrays;       ///< as written: one, or one a component; empty: the only one
  std::string interpolation;             ///< linear | cubic
  std::string time_interpolation;        ///< linear | cubic
  std::string outside;                   ///< what holds outside of the grid: error | clamp | zero
  std::string missing;                   ///< what holds where the file has no value
  std::optional<double> missing_value;   ///< a number that marks missing data, besides those that are recognised
  std::string mask;                      ///< of an array that says where there is water; empty: none
  std::string mask_is;                   ///< what its numbers other than 0 are: water | land; empty: as the file says
  std::optional<FileClock> clock;        ///< the times of the scene
  std::optional<double> level;           ///< of a fourth dimension, the layer that is read
  std::string gaps;                      ///< what happens where a snapshot is missing: warn | error | bridge
  std::string duplicates;                ///< which of two snapshots for one time counts: error | first | last
  std::shared_ptr<const GridData> data;  ///< the numbers

  /// The same words of a case: the numbers may have been read twice.
  bool operator==(const GridFileSpec& other) const {
    return file == other.file && arrays == other.arrays && interpolation == other.interpolation &&
           time_interpolation == other.time_interpolation && outside == other.outside && missing == other.missing &&
           missing_value == other.missing_value && mask == other.mask && mask_is == other.mask_is &&
           clock == other.clock && level == other.level && gaps == other.gaps && duplicates == other.duplicates;
  }
};
/// A velocity on a grid.
struct FileVelocitySpec : GridFileSpec {};
/// gaussians = "...": divergence-free Gaussians at the points of a table, already read and fitted.
struct GaussianVelocitySpec {
  std::filesystem::path file;  ///< absolute
  std::string kind;            ///< of the numbers in it: "velocity", "vorticity", ...
  double residual = 0;         ///< of a fit: what is left of the samples, in the Euclidean norm
  double regularisation = 0;   ///< of a fit: added to the diagonal of its matrix, relative to that
  double tolerance = 0;        ///< of the sum of the Gaussians, relative to the largest velocity at the points
  std::shared_ptr<const GaussianModel> model;  ///< the Gaussians
};
/// samples = "...": a function through the numbers of a table of scattered points, already read and fitted.
struct SamplesSpec {
  std::filesystem::path file;            ///< absolute
  std::string kernel;                    ///< of rbf, by name
  double width = 0;                      ///< shape of the kernel, given or chosen; 0 where it takes none
  double regularisation = 0;             ///< added to the diagonal of the equations
  std::string outside;                   ///< what holds outside of the samples: error | clamp | zero
  std::shared_ptr<const SampleFit> fit;  ///< the function
};
/// The same of a velocity.
struct SamplesVelocitySpec : SamplesSpec {
  bool divergence_free = false;  ///< one matrix kernel for all components
};
/// One `[[velocity]]`.
using VelocitySpec = std::variant<ExpressionVelocitySpec, StreamfunctionVelocitySpec, NamedVelocitySpec,
                                  FileVelocitySpec, GaussianVelocitySpec, SamplesVelocitySpec>;

// --- initial density --------------------------------------------------------------------------------------------

/// expression = "...": rho_0 in x, y, z and the params.
struct ExpressionDensitySpec {
  std::string text;  ///< the expression
};
/// shape = "...": a named shape (docs/cases.md gives the formulas) with all of its parameters.
struct ShapeDensitySpec {
  std::string shape;    ///< its name
  Arguments arguments;  ///< all of its parameters
};
/// A density on a grid.
struct FileDensitySpec : GridFileSpec {};
/// samples = "...": a function through the values of a table of scattered points.
struct SamplesDensitySpec : SamplesSpec {};
/// One `[[density]]`.
using DensitySpec = std::variant<ExpressionDensitySpec, ShapeDensitySpec, FileDensitySpec, SamplesDensitySpec>;

/// A tracer: the densities of one name. Particles carry all tracers beside each other.
struct TracerSpec {
  std::string name;                   ///< in files, pictures and expressions
  std::vector<std::size_t> parts{};   ///< of `Case::density`
  std::string gain{};                 ///< in a unit of time: an expression in tracers, place and time; empty: none
  std::optional<double> half_life{};  ///< after which half of it is gone
  std::string exact{};                ///< its exact density, an expression in place and time; empty: not given
  std::optional<double> diffusion{};  ///< its own coefficient of diffusion; empty: that of [effects.diffusion]
};

// --- what enters during the run ---------------------------------------------------------------------------------

/// point = [...]: one blob.
struct PointSourceSpec {
  std::vector<double> place;  ///< one number a dimension
  double amount = 0;          ///< of a release at one time; with a rate that says it
};
/// face = "...": what the velocity carries in through a face of the domain.
struct FaceSourceSpec {
  int axis = 0;               ///< across which the face lies
  bool upper = false;         ///< at the upper end of the axis
  std::string concentration;  ///< of what comes in: an expression in place, time and the params
};
/// points = "...": a table of blobs, each with its own time and amount, already read.
struct PointsSourceSpec {
  std::filesystem::path file;                       ///< absolute
  std::shared_ptr<const std::vector<double>> rows;  ///< x, y, z in space, t, amount; row after row
};
/// One `[[source]]`.
struct SourceSpec {
  /// A shape is a density to be released.
  std::variant<ShapeDensitySpec, PointSourceSpec, PointsSourceSpec, FaceSourceSpec> what;
  std::optional<double> at{};  ///< everything at this time; empty: over an interval, or as the table says
  double from = 0;             ///< begin of the interval
  double to = 0;               ///< end of the interval
  std::string rate{};          ///< an expression in t and the params; empty: at one time, or as the table says
  int puffs = 0;               ///< into which the interval is divided
  std::size_t tracer = 0;      ///< of `Case::tracers`, that is released
};

// --- discretisation ---------------------------------------------------------------------------------------------

/// `[particles]`: the lattice on which particles start, and the blob that each carries.
struct ParticleSpec {
  int per_axis = 0;               ///< n_g on the longest axis
  double overlap = 2;             ///< c: eps = c h
  std::string cutoff = "gauss2";  ///< name of a cutoff
  Arguments cutoff_arguments{};   ///< of its parameters; what is left out has its default
  double threshold = 1e-12;       ///< part of the largest weight below which a lattice point has no particle
};

/// `[time]`: how long, and in which steps. All times of a case (`end`, outputs, sources, checks) are elapsed ones: they
/// count from the beginning of the run and go up, also where the run goes backwards in time. at() tells what the clock of
/// the case shows then: the t of expressions and data, and of all that a run tells.
struct TimeSpec {
  double end = 0;              ///< T: elapsed when the run ends
  double step = 0;             ///< tau; the largest step where the method chooses its own, 0: none is
  double tolerance = 1e-8;     ///< of one step, where the method chooses it; relative to the longest side of the domain
  std::string method = "rk4";  ///< name of a tableau
  double start = 0;            ///< what the clock shows when the run begins
  bool backwards = false;      ///< the clock goes down
  std::function<std::string(double t)> date{};  ///< of a time that the clock shows; empty: data of the case have none

  /// What the clock shows after that time.
  double at(double elapsed) const { return backwards ? start - elapsed : start + elapsed; }
  /// After which time the clock shows t. What it shows then, rounded, has the same elapsed time.
  double elapsed(double t) const {
    double since = backwards ? start - t : t - start;
    for (int i = 0; i < 4; ++i) {
      const double shown = at(since), again = backwards ? start - shown : shown - start;
      if (again == since) break;
      since = again;
    }
    return since;
  }
  /// Elapsed times are those of the clock.
  bool is_plain() const { return start == 0 && !backwards; }
};

/// Parameters of the method `hermite` by hand, in the letters of [Sch06, Table A.1].
struct HermiteSpec {
  double r = 0.5;  ///< boxes have the side r sqrt(2/sigma); 0 < r < 1
  int p = 9;       ///< terms of the series on each axis
  int n = -1;      ///< boxes to each side, on each axis, whose sources count; -1: all
};

/// `[evaluate]`: the grid on which the density is summed for output.
struct EvaluateSpec {
  int per_axis = 200;                       ///< n_ge on the longest axis
  double spacing = 0;                       ///< of the points on all axes; 0: per_axis says it
  double tolerance = 1e-8;                  ///< of the Gauss transform, relative to max |rho| at that output
  std::string method = "auto";              ///< auto, or a method of fgtd by name
  std::optional<HermiteSpec> hermite = {};  ///< with method "hermite"; by default chosen for the tolerance
  double tile_particles = 0;                ///< most particles of a tile; 0: 2^18 in the plane, 2^20 in space
  double piece_points = 33554432;  ///< most points of a grid, or of a piece of it, that is held and written at once
  double most_seconds = 0;         ///< that a density may be predicted to take; 0: 300 for a named method, any for auto
};

/// A kind of files that a run writes for ParaView, as far as a case and predictions need to know it. `write` has all
/// of them, and writes them.
struct OutputFile {
  std::string_view name;        ///< in a case, of the files, and of the folder that they lie in
  std::string_view meaning;     ///< one line
  bool by_default = false;      ///< written where a case does not say which
  bool needs_velocity = false;  ///< the particles, with the velocity there
  bool shows_density = false;   ///< and the exact one, where that is known at all points of the grid
};

/// A style of pictures, as far as a case and predictions need to know it. `render` has all of them, and draws them.
struct PictureStyle {
  std::string_view name;     ///< in a case, and of the pictures
  std::string_view meaning;  ///< one line
  int least_dimension = 2;   ///< of the densities that it shows
  int most_dimension = 3;    ///< the same
  bool by_default = false;   ///< drawn where a case does not say which
  bool shows_error = false;  ///< shows the difference from the exact density: needs a reference
  /// The field that it shows beside the density: needs it in `output.fields`, and density files, from which it may be
  /// read again. Empty: none.
  std::string_view needs_field = {};

  /// Densities of this dimension?
  bool shows(int dimension) const { return least_dimension <= dimension && dimension <= most_dimension; }
};

/// A quantity that a run shows on its grid beside the density, as far as a case and predictions need to know it.
struct GridField {
  std::string_view name;               ///< in a case, and of the array in files
  std::string_view meaning;            ///< one line
  std::array<bool, 2> is_vector = {};  ///< in the plane, in space; else it is a number
  bool is_of_flow = false;             ///< it follows from the prescribed velocity alone
  bool is_matrix = false;              ///< a matrix, row after row
  bool is_of_particles = false;        ///< it belongs to particles: files of particles have it
  bool is_on_grid = true;              ///< density files have it, too
};

/// A kind of files that tracks are written to, as far as a case needs to know it. `write` has all of them.
struct TrackFile {
  std::string_view name;     ///< in a case
  std::string_view meaning;  ///< one line
  bool by_default = false;   ///< written where a case does not say which
};

/// `[output.tracks]`: which particles are followed, and what is told along their paths.
struct TracksSpec {
  std::vector<std::int64_t> ids;  ///< of particles
  int every = 0;                  ///< every n-th along each axis of the lattice, every n-th of those released; 0: none
  std::filesystem::path file{};   ///< absolute: a table of points that go with the flow; empty: none
  std::shared_ptr<const std::vector<double>> points{};  ///< x, y, z in space, row after row; null: none
  int steps = 0;                                        ///< a look after so many steps; 0: at outputs alone
  std::vector<GridField> fields{};                      ///< beside place and time
  std::vector<TrackFile> files{};                       ///< beside the table
};

/// Frames of the run on its page, which the page plays.
struct PageSpec {
  bool plays = true;     ///< else the page has pictures alone
  double megabytes = 5;  ///< most of report.html; 10^6 bytes each
};

/// `[output]`: when to write, and what.
struct OutputSpec {
  std::vector<double> times;         ///< elapsed, ascending, 0 <= t <= end
  std::vector<OutputFile> files;     ///< files that are written at each of these times
  std::vector<PictureStyle> images;  ///< pictures of every output
  std::vector<GridField> fields;     ///< in the files, beside the density
  bool report = true;                ///< report.html, report.json, summary.png
  PageSpec page{};                   ///< what moves on that page
  double piece_particles = 4194304;  ///< most particles of a file: more are written in pieces
  /// Seconds between two checkpoints; 0: none; empty: about a minute in runs of more than five.
  std::optional<double> checkpoint{};
  std::optional<TracksSpec> tracks{};        ///< empty: nobody is followed
  PicturesSpec pictures{};                   ///< how they look
  std::optional<AnimationSpec> animation{};  ///< empty: there is none
};

// --- what the results are compared with -------------------------------------------------------------------------

/// `[reference]`: the exact density that every output is compared with.
struct ReferenceSpec {
  /// How it is known.
  enum class Kind {
    characteristics,  ///< traced back along the flow; docs/method.md, section 7
    exact,            ///< a formula
    none              ///< not at all
  };
  Kind kind = Kind::none;       ///< how it is known
  std::string rho;              ///< exact: an expression in x, y, z, t and the params
  std::optional<int> points{};  ///< most points of the grid that are compared; empty: chosen
};

/// A bound on a number of the outputs. The norms of the error are relative to those of the exact density at the same
/// time, masses to that at the start.
struct CheckSpec {
  /// What is bounded.
  enum class Quantity {
    linf,      ///< largest difference from the reference
    l1,        ///< its integral
    l2,        ///< its root mean square
    mass,      ///< the sum of all weights
    inside,    ///< the sum of the weights of particles inside the domain
    left,      ///< of those that have left the run
    released,  ///< of those that sources have released, not relative to anything
    stopped,   ///< of those that lie on land
    largest,   ///< value of a field of the particles
    mean       ///< of its values
  };
  /// True if it is a norm of the error, which needs a reference.
  bool is_error() const { return what == Quantity::linf || what == Quantity::l1 || what == Quantity::l2; }
  /// True if it is of a field of the particles.
  bool is_of_field() const { return what == Quantity::largest || what == Quantity::mean; }

  Quantity what = Quantity::linf;  ///< what is bounded
  std::string by{};                ///< of what has left: the reason; empty: any
  std::string tracer{};            ///< of which tracer; empty: of all together
  std::string field{};             ///< of the particles, whose largest value or mean it is
  std::optional<double> max{};     ///< upper bound; there is this one, the lower one, or both
  std::optional<double> min{};     ///< lower bound
  std::optional<double> at{};      ///< one of the output times, elapsed; none: all of them
};

// --- effects ----------------------------------------------------------------------------------------------------

/// `[effects.name]`: an effect that the case names, with the values of its keys. docs/cases.md lists effects and keys.
struct EffectSpec {
  std::string name;                                          ///< of an effect of the catalogue
  Arguments numbers{};                                       ///< numbers and points by key, defaults included
  std::vector<std::pair<std::string, std::string>> texts{};  ///< choices and expressions by key, defaults included
  std::optional<GridFileSpec> file{};                        ///< the values of the effect's field, on a grid

  /// True if the key has a value.
  bool has(std::string_view key) const {
    const auto is_it = [key](const auto& entry) { return entry.first == key; };
    return std::any_of(numbers.begin(), numbers.end(), is_it) || std::any_of(texts.begin(), texts.end(), is_it) ||
           (file && key == "file");
  }
  /// The numbers of a key, one a dimension. Throws std::out_of_range if the key has none.
  const std::vector<double>& point(std::string_view key) const {
    for (const auto& [name_of_key, values] : numbers)
      if (name_of_key == key) return values;
    throw std::out_of_range("[effects." + name + "] has no number " + std::string(key));
  }
  /// The number of a key. Throws std::out_of_range if the key has none.
  double number(std::string_view key) const { return point(key).at(0); }
  /// The choice or expression of a key. Throws std::out_of_range if the key has none.
  const std::string& text(std::string_view key) const {
    for (const auto& [name_of_key, value] : texts)
      if (name_of_key == key) return value;
    throw std::out_of_range("[effects." + name + "] has no text " + std::string(key));
  }
  /// Replaces the number of a key, or adds it.
  void set(std::string_view key, double value) {
    for (auto& [name_of_key, values] : numbers)
      if (name_of_key == key) return void(values = {value});
    numbers.emplace_back(key, std::vector<double>{value});
  }
  /// Same name, same values.
  bool operator==(const EffectSpec&) const = default;
};

/// The effects that a case names; what is absent is not constructed.
struct EffectsSpec {
  std::vector<EffectSpec> list;  ///< each effect at most once, in any order

  /// The effect of that name; null if the case does not name it.
  const EffectSpec* find(std::string_view name) const {
    for (const EffectSpec& effect : list)
      if (effect.name == name) return &effect;
    return nullptr;
  }
  /// Replaces the effect of the same name, or adds it.
  void set(EffectSpec effect) {
    for (EffectSpec& old : list)
      if (old.name == effect.name) return void(old = std::move(effect));
    list.push_back(std::move(effect));
  }
  /// Takes the effect out, if it is there.
  void remove(std::string_view name) {
    std::erase_if(list, [name](const EffectSpec& effect) { return effect.name == name; });
  }
  /// The same effects with the same values.
  bool operator==(const EffectsSpec&) const = default;
};

/// `[accuracy]`: how accurate it has to be, and whether a run tells its errors apart by cause.
struct AccuracySpec {
  /// Whether a run measures its errors by cause; docs/method.md, section 10.
  enum class Budget {
    automatic,  ///< where that costs a small part of the run
    measured,   ///< always
    none        ///< never
  };
  Budget budget = Budget::automatic;  ///< whether errors are told apart
  /// Largest error at the last output, relative to max |rho|; settings are chosen for it.
  std::optional<double> target{};
};

/// A whole case, as a file describes it.
struct Case {
  std::string name;                    ///< stem of the file: names the output folder
  std::filesystem::path file;          ///< where it came from; empty for a case built in memory
  std::string source;                  ///< text of that file
  std::string title;                   ///< one line for pictures and reports
  std::string cite;                    ///< where the case comes from
  std::string label = "density";       ///< what pictures and pages call the density
  Params params;                       ///< `[params]`
  Domain domain;                       ///< `[domain]`
  std::vector<VelocitySpec> velocity;  ///< the fields add up
  std::vector<DensitySpec> density;    ///< the densities add up; with sources there may be none
  std::vector<TracerSpec> tracers;     ///< of named densities; empty: the densities are one, without a name
  std::vector<SourceSpec> sources;     ///< what enters during the run
  ParticleSpec particles;              ///< `[particles]`
  TimeSpec time;                       ///< `[time]`
  EvaluateSpec evaluate;               ///< `[evaluate]`
  OutputSpec output;                   ///< `[output]`
  EffectsSpec effects;                 ///< `[effects.*]`
  ReferenceSpec reference;             ///< `[reference]`
  AccuracySpec accuracy;               ///< `[accuracy]`
  std::vector<CheckSpec> checks;       ///< `[[check]]`
};

}  // namespace gaussdrift
