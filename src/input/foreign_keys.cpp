#include "input/foreign_keys.hpp"

#include <fmt/format.h>

#include <cctype>
#include <string>

#include "base/catalogue.hpp"
#include "effect/catalogue.hpp"
#include "time/tableau.hpp"

namespace gaussdrift::input {
namespace {

constexpr const char* edges =
    "edges = [\"periodic\", \"closed\"] in [domain] has a word for each axis: periodic, closed (a wall), open or "
    "unbounded";
constexpr const char* prescribed = "the velocity is prescribed, in [velocity]; no equation of motion is solved";
constexpr const char* no_mesh =
    "there is no mesh: particles.per_axis is the number of particles along the longest side, evaluate.per_axis that of "
    "points where density is written";
constexpr const char* end_of_run = "a run goes from time.start to time.end";
constexpr const char* width = "particles.overlap is the core radius of a blob divided by the particles' spacing";
constexpr const char* data_formats =
    "output.vtk writes files for ParaView, series.csv has numbers for every output time, pictures are PNG";
constexpr const char* no_random = "nothing is random here: the same case gives the same results";
constexpr const char* again =
    "[density] file = \"density/density_0004.vti\" starts from the density that an earlier run wrote";

/// Without a string that is allocated before main.
struct Written {
  std::string_view word, key, answer;
};

constexpr Written written_elsewhere[] = {
    {"boundary", "", edges},
    {"boundaries", "", edges},
    {"boundarycondition", "", edges},
    {"boundaryconditions", "", edges},
    {"bc", "", edges},
    {"bcs", "", edges},
    {"wall", "", edges},
    {"walls", "", edges},
    {"obstacle", "", edges},
    {"obstacles", "", edges},
    {"noslip", "", edges},
    {"reflect", "", edges},
    {"reflecting", "", edges},
    {"periodic", "", edges},
    {"periodicity", "", edges},
    {"wrap", "", edges},
    {"outflow", "", edges},
    {"outlet", "", edges},
    {"gravity", "", prescribed},
    {"pressure", "", prescribed},
    {"temperature", "", prescribed},
    {"forcing", "", prescribed},
    {"mesh", "", no_mesh},
    {"grid", "", no_mesh},
    {"cells", "", no_mesh},
    {"resolution", "", no_mesh},
    {"nx", "", no_mesh},
    {"ny", "", no_mesh},
    {"nz", "", no_mesh},
    {"dx", "", no_mesh},
    {"dy", "", no_mesh},
    {"dz", "", no_mesh},
    {"tmax", "time.end", end_of_run},
    {"tend", "time.end", end_of_run},
    {"tfinal", "time.end", end_of_run},
    {"endtime", "time.end", end_of_run},
    {"stoptime", "time.end", end_of_run},
    {"duration", "time.end", end_of_run},
    {"starttime", "time.start", end_of_run},
    {"tstart", "time.start", end_of_run},
    {"tbegin", "time.start", end_of_run},
    {"t0", "time.start", end_of_run},
    {"integrator", "time.method", "a Runge-Kutta method"},
    {"solver", "time.method", "a Runge-Kutta method"},
    {"scheme", "time.method", "a Runge-Kutta method"},
    {"sigma", "particles.overlap", width},
    {"eps", "particles.overlap", width},
    {"epsilon", "particles.overlap", width},
    {"bandwidth", "particles.overlap", width},
    {"smoothinglength", "particles.overlap", width},
    {"coreradius", "particles.overlap", width},
    {"kernel", "particles.cutoff", "the blob that every particle carries"},
    {"initial", "", "the density at t = 0 is [density]"},
    {"ic", "", "the density at t = 0 is [density]"},
    {"initialcondition", "", "the density at t = 0 is [density]"},
    {"wind", "", "the velocity is [velocity]"},
    {"flow", "", "the velocity is [velocity]"},
    {"advection", "", "the velocity is [velocity]"},
    {"seed", "", no_random},
    {"restart", "", again},
    {"checkpoint", "", again},
    {"format", "", data_formats},
    {"netcdf", "", data_formats},
    {"nc", "", data_formats},
    {"hdf5", "", data_formats},
    {"csv", "", data_formats},
    {"png", "", data_formats},
};

/// Words for the time step.
constexpr std::string_view steps[] = {"dt", "deltat", "timestep", "stepsize", "cfl", "courant"};

std::vector<ForeignKey> all_keys() {
  std::vector<ForeignKey> all;
  for (const auto& [word, key, answer] : written_elsewhere) all.push_back({word, key, std::string(answer)});
  const std::string answer =
      fmt::format("time.step is the time step; method = {} chooses its own", time::adaptive_names());
  for (const std::string_view word : steps) all.push_back({word, "time.step", answer});
  for (const NamedEffect& effect : effects())
    for (const auto& [word, meant] : effect.elsewhere) all.push_back({word, "", std::string(meant)});
  return all;
}

}  // namespace

const std::vector<ForeignKey>& foreign_keys() {
  static base::FromCatalogues<std::vector<ForeignKey>> list;
  return list.get(all_keys);
}

const ForeignKey* find_foreign_key(std::string_view word) {
  std::string bare;
  for (const char c : word)
    if (c != '_' && c != '-') bare += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  for (const ForeignKey& known : foreign_keys())
    if (known.word == bare) return &known;
  return nullptr;
}

}  // namespace gaussdrift::input
