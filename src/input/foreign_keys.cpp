#include "input/foreign_keys.hpp"

#include <algorithm>
#include <cctype>
#include <iterator>
#include <string>

namespace gaussdrift::input {
namespace {

constexpr std::string_view no_walls =
    "the domain has no walls: particles move through all of space, and what leaves the domain is not drawn; a velocity "
    "without flow through a wall keeps them inside, as a streamfunction that is constant along it";
constexpr std::string_view not_periodic =
    "the domain is not periodic: particles that leave it do not come back; the velocity may be periodic, as "
    "sin(2*pi*x), in a domain wide enough for what moves";
constexpr std::string_view nothing_enters =
    "all mass is there at the start, in [density]; [effects.reaction] lets it decay, or grow with a negative rate";
constexpr std::string_view prescribed = "the velocity is prescribed, in [velocity]; no equation of motion is solved";
constexpr std::string_view no_mesh =
    "there is no mesh: particles.per_axis is the number of particles along the longest side, evaluate.per_axis that of "
    "points where density is written";
constexpr std::string_view end_of_run = "a run goes from t = 0 to time.end";
constexpr std::string_view steps = "time.step is the time step; method = \"dopri5\" chooses its own";
constexpr std::string_view diffuses = "[effects.diffusion] with the coefficient D";
constexpr std::string_view width = "particles.overlap is the core radius of a blob divided by the particles' spacing";
constexpr std::string_view formats =
    "output.vtk writes files for ParaView, series.csv has numbers for every output time, pictures are PNG";
constexpr std::string_view no_random = "nothing is random here: the same case gives the same results";
constexpr std::string_view again =
    "[density] file = \"density/density_0004.vti\" starts from the density that an earlier run wrote";

constexpr ForeignKey list[] = {
    {"boundary", "", no_walls},
    {"boundaries", "", no_walls},
    {"boundarycondition", "", no_walls},
    {"boundaryconditions", "", no_walls},
    {"bc", "", no_walls},
    {"bcs", "", no_walls},
    {"wall", "", no_walls},
    {"walls", "", no_walls},
    {"obstacle", "", no_walls},
    {"obstacles", "", no_walls},
    {"noslip", "", no_walls},
    {"reflect", "", no_walls},
    {"reflecting", "", no_walls},
    {"periodic", "", not_periodic},
    {"periodicity", "", not_periodic},
    {"wrap", "", not_periodic},
    {"inflow", "", nothing_enters},
    {"inlet", "", nothing_enters},
    {"outflow", "", no_walls},
    {"outlet", "", no_walls},
    {"source", "", nothing_enters},
    {"sources", "", nothing_enters},
    {"sink", "", nothing_enters},
    {"emission", "", nothing_enters},
    {"emissions", "", nothing_enters},
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
    {"dt", "time.step", steps},
    {"deltat", "time.step", steps},
    {"timestep", "time.step", steps},
    {"stepsize", "time.step", steps},
    {"cfl", "time.step", steps},
    {"courant", "time.step", steps},
    {"tmax", "time.end", end_of_run},
    {"tend", "time.end", end_of_run},
    {"tfinal", "time.end", end_of_run},
    {"endtime", "time.end", end_of_run},
    {"stoptime", "time.end", end_of_run},
    {"duration", "time.end", end_of_run},
    {"start", "", end_of_run},
    {"starttime", "", end_of_run},
    {"t0", "", end_of_run},
    {"integrator", "time.method", "a Runge-Kutta method"},
    {"solver", "time.method", "a Runge-Kutta method"},
    {"scheme", "time.method", "a Runge-Kutta method"},
    {"diffusivity", "", diffuses},
    {"viscosity", "", diffuses},
    {"nu", "", diffuses},
    {"kappa", "", diffuses},
    {"decay", "", "[effects.reaction] with its rate"},
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
    {"format", "", formats},
    {"netcdf", "", formats},
    {"nc", "", formats},
    {"hdf5", "", formats},
    {"csv", "", formats},
    {"png", "", formats},
};

}  // namespace

std::span<const ForeignKey> foreign_keys() { return list; }

const ForeignKey* find_foreign_key(std::string_view word) {
  std::string bare;
  for (const char c : word)
    if (c != '_' && c != '-') bare += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  const auto found =
      std::find_if(std::begin(list), std::end(list), [&](const ForeignKey& known) { return known.word == bare; });
  return found == std::end(list) ? nullptr : found;
}

}  // namespace gaussdrift::input
