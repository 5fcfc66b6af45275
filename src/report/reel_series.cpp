#include "report/reel_series.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include "gaussdrift/error.hpp"
#include "read/written_run.hpp"
#include "write/output_files.hpp"

namespace gaussdrift::report {

namespace {

constexpr double most_rest = 6e5;  // bytes of a page beside its frames: the picture, tables, scripts
constexpr std::size_t most_particles = 2000;
constexpr std::size_t most_arrows = 28;  // along an axis

/// Differences from the exact density.
std::vector<double> error_of(const std::vector<double>& rho, const std::vector<double>& exact) {
  std::vector<double> error(rho.size());
  for (std::size_t i = 0; i < rho.size(); ++i) error[i] = rho[i] - exact[i];
  return error;
}

std::vector<double> component_of(const FieldOnGrid& field, std::size_t which) {
  const auto all = static_cast<std::size_t>(field.components);
  std::vector<double> values(field.values.size() / all);
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = field.values[i * all + which];
  return values;
}

/// Of vectors and matrices; of a number itself.
std::vector<double> length_of(const FieldOnGrid& field) {
  if (field.components == 1) return field.values;
  const auto all = static_cast<std::size_t>(field.components);
  std::vector<double> length(field.values.size() / all);
  for (std::size_t i = 0; i < length.size(); ++i) {
    double sum = 0;
    for (std::size_t k = 0; k < all; ++k) sum += field.values[i * all + k] * field.values[i * all + k];
    length[i] = std::sqrt(sum);
  }
  return length;
}

void add_arrows(const Lattice& lattice, const FieldOnGrid& velocity, std::vector<Stream>& streams) {
  const std::size_t longest = *std::max_element(lattice.points.begin(), lattice.points.end());
  const std::size_t every = std::max<std::size_t>(1, (longest + most_arrows - 2) / (most_arrows - 1));
  for (int k = 0; k < velocity.components; ++k)
    streams.push_back(stream_on_grid(std::string("arrows.") + "uvw"[k], lattice,
                                     component_of(velocity, static_cast<std::size_t>(k)), every));
}

void add_fields(Reel& reel, const Lattice& lattice, const std::vector<FieldOnGrid>& fields,
                std::vector<Stream>& streams) {
  for (const FieldOnGrid& field : fields) {
    streams.push_back(
        reel.on_grid(field.components == 1 ? field.name : "|" + field.name + "|", lattice, length_of(field)));
    if (field.name == "velocity" && field.components > 1) add_arrows(lattice, field, streams);
  }
}

/// Those whose ids are multiples of a power of two, so that they are not too many: the same in all outputs as long as
/// their number is about the same. In the order of ids.
void add_particles(const Particles& particles, const std::vector<double>* velocity, std::vector<Stream>& streams) {
  std::vector<std::size_t> chosen;
  for (std::int64_t every = 1; chosen.empty() || chosen.size() > most_particles; every *= 2) {
    chosen.clear();
    for (std::size_t j = 0; j < particles.size(); ++j)
      if (particles.id[j] % every == 0) chosen.push_back(j);
    if (chosen.empty()) return;
  }
  std::sort(chosen.begin(), chosen.end(),
            [&](std::size_t a, std::size_t b) { return particles.id[a] < particles.id[b]; });
  const auto add = [&](const std::string& name, const auto& value) {
    std::vector<double> values;
    values.reserve(chosen.size());
    for (const std::size_t j : chosen) values.push_back(value(j));
    streams.push_back(stream_of(name, 0, {static_cast<std::uint32_t>(chosen.size()), 1, 1}, values));
  };
  const auto dimension = static_cast<std::size_t>(particles.dimension);
  for (std::size_t k = 0; k < dimension; ++k) {
    add(std::string("particles.") + "xyz"[k], [&](std::size_t j) { return particles.position[k][j]; });
    if (velocity)
      add(std::string("particles.") + "uvw"[k], [&](std::size_t j) { return (*velocity)[j * dimension + k]; });
  }
}

class ReelSeries : public Observer {
 public:
  ReelSeries(std::shared_ptr<Reel> reel, const TimeSpec& clock, bool has_particles)
      : reel_(std::move(reel)), date_(clock.date), has_particles_(has_particles) {}
  std::string name() const override { return "page"; }
  bool needs_particles(double /*elapsed*/) const override { return has_particles_; }

  void frame(const Frame& frame) override {
    ReelFrame kept{static_cast<std::uint64_t>(frame.index), frame.time, date_ ? date_(frame.time) : "", {}};
    const DensityGrid& density = *frame.density;
    kept.streams.push_back(reel_->on_grid("rho", density.lattice, density.rho));
    if (frame.exact)
      kept.streams.push_back(reel_->on_grid("error", density.lattice, error_of(density.rho, *frame.exact)));
    add_fields(*reel_, density.lattice, density.fields, kept.streams);
    if (has_particles_ && frame.particle_pieces == 1) add_particles(*frame.particles, frame.velocity, kept.streams);
    reel_->add(std::move(kept));
  }

  std::string state() const override {
    base::StateBytes bytes;
    reel_->pass(bytes);
    return bytes.written();
  }

  void restore(const std::vector<std::pair<double, FrameNumbers>>& frames, const std::string& state) override {
    if (state.empty()) return;  // an earlier part of the run gathered none
    base::StateBytes bytes(state);
    reel_->pass(bytes);
    bytes.end();
    reel_->keep_first(frames.size());
  }

 private:
  std::shared_ptr<Reel> reel_;
  std::function<std::string(double)> date_;
  bool has_particles_;
};

}  // namespace

std::size_t most_reel_bytes(const PageSpec& page) {
  return static_cast<std::size_t>(std::max(1e5, page.megabytes * 1e6 - most_rest) * 3 / 4);  // as text
}

std::unique_ptr<Observer> reel_series(std::shared_ptr<Reel> reel, const Case& spec, bool has_particles) {
  return std::make_unique<ReelSeries>(std::move(reel), spec.time, has_particles);
}

Reel reel_from_files(const std::filesystem::path& folder, std::size_t most_bytes) {
  Reel reel(most_bytes);
  for (const read::WrittenOutput& output : read::written_outputs(folder, write::density_output().about.name)) {
    ReelFrame kept{output.number, output.time.value_or(static_cast<double>(output.number)), "", {}};
    for (const char* name : {"rho", "error"}) {
      try {
        const DensityGrid grid = read::read_density(output.file, name);
        kept.streams.push_back(reel.on_grid(name, grid.lattice, grid.rho));
      } catch (const FileError&) {
        if (name == std::string_view("rho")) throw;  // the error is not always there
      }
    }
    reel.add(std::move(kept));
  }
  return reel;
}

}  // namespace gaussdrift::report
