#include "write/observers.hpp"

#include <fmt/format.h>

#include "base/stopwatch.hpp"
#include "write/atomic_file.hpp"
#include "write/vtk_files.hpp"

namespace gaussdrift::write {

namespace fs = std::filesystem;

namespace {

class DensityFiles : public Observer {
 public:
  explicit DensityFiles(const fs::path& folder) : folder_(folder), collection_(folder / "density.pvd") {}
  std::string name() const override { return "write density"; }
  void frame(const Frame& frame) override {
    const fs::path file = folder_ / "density" / fmt::format("density_{:04}.vti", frame.index);
    write_density(file, *frame.density, frame.time, frame.exact);
    collection_.add(frame.time, file);
  }

 private:
  fs::path folder_;
  Collection collection_;
};

class ParticleFiles : public Observer {
 public:
  explicit ParticleFiles(const fs::path& folder) : folder_(folder), collection_(folder / "particles.pvd") {}
  std::string name() const override { return "write particles"; }
  void frame(const Frame& frame) override {
    const fs::path file = folder_ / "particles" / fmt::format("particles_{:04}.vtp", frame.index);
    write_particles(file, *frame.particles, *frame.velocity, frame.time);
    collection_.add(frame.time, file);
  }

 private:
  fs::path folder_;
  Collection collection_;
};

class SeriesTable : public Observer {
 public:
  SeriesTable(const fs::path& folder, int dimension, bool errors)
      : file_(folder / "series.csv"), dimension_(dimension), errors_(errors) {
    table_ = "t,mass,minimum,maximum,centroid_x,centroid_y";
    table_ += dimension == 3 ? ",centroid_z" : "";
    table_ += ",transform_error";
    table_ += errors ? ",L1,L2,Linf" : "";
    table_ += ",outside,evaluate_seconds,seconds\n";
  }
  std::string name() const override { return "write series"; }
  void frame(const Frame& frame) override {
    const FrameNumbers& n = frame.numbers;
    table_ += fmt::format("{:.17g},{:.17g},{:.17g},{:.17g}", frame.time, n.mass, n.minimum, n.maximum);
    for (int k = 0; k < dimension_; ++k) table_ += fmt::format(",{:.17g}", n.centroid[k]);
    table_ += fmt::format(",{:.3e}", n.transform_error);
    const ErrorNorms error = n.error.value_or(ErrorNorms{});
    if (errors_) table_ += fmt::format(",{:.6e},{:.6e},{:.6e}", error.l1, error.l2, error.linf);
    table_ += fmt::format(",{:.17g},{:.6f},{:.6f}\n", n.outside, n.evaluate_seconds, watch_.seconds());
    write_text(file_, table_);
  }

 private:
  fs::path file_;
  int dimension_;
  bool errors_;
  std::string table_;
  base::Stopwatch watch_;  // runs from the start of the run
};

}  // namespace

std::unique_ptr<Observer> density_files(const fs::path& folder) { return std::make_unique<DensityFiles>(folder); }
std::unique_ptr<Observer> particle_files(const fs::path& folder) { return std::make_unique<ParticleFiles>(folder); }
std::unique_ptr<Observer> series_table(const fs::path& folder, int dimension, bool errors) {
  return std::make_unique<SeriesTable>(folder, dimension, errors);
}

}  // namespace gaussdrift::write
