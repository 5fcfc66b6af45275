#include "cli/drawable.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <utility>

#include "cli/outputs_of.hpp"
#include "gaussdrift/error.hpp"
#include "gaussdrift/read_case.hpp"
#include "reference/coordinates.hpp"
#include "render/film_frames.hpp"
#include "render/picture.hpp"
#include "sim/fields_on_grid.hpp"
#include "sim/grid_fields.hpp"
#include "sim/grid_pieces.hpp"
#include "sim/make_fields.hpp"
#include "sim/moments.hpp"
#include "sim/scene.hpp"
#include "write/folder_facts.hpp"

namespace gaussdrift::cli {

namespace fs = std::filesystem;

namespace {

/// Title and dates of the case of a run, where its folder tells them.
void take_heading(const fs::path& folder, Drawable& drawable) {
  const fs::path named = (folder / "").parent_path();  // "a/b/" is "a/b"
  drawable.title = named.stem().string();
  const fs::path file = folder / "run.toml";
  if (!fs::is_regular_file(file)) return;
  try {
    Case spec = read_case(file, {}, 0).spec;
    const std::string name = write::name_of_run(folder);
    drawable.title = !spec.title.empty() ? spec.title : name.empty() ? drawable.title : name;
    drawable.date = spec.time.date;
    drawable.label = spec.label;
  } catch (const Error&) {  // pictures need none of it; a run may have lost its data
  }
}

}  // namespace

Drawable outputs_to_draw(const fs::path& place, bool locked) {
  const auto outputs = std::make_shared<const std::vector<read::WrittenOutput>>(outputs_of(place, locked));
  Drawable drawable;
  if (fs::is_directory(place))
    take_heading(place, drawable);
  else
    drawable.title = place.stem().string();
  for (const read::WrittenOutput& output : *outputs)
    drawable.times.push_back(output.time), drawable.numbers.push_back(output.number);
  drawable.density = [outputs](std::size_t i, const std::string& field, const std::vector<std::string>& vectors) {
    DensityGrid density = read::read_density((*outputs)[i].file, field);
    for (const std::string& name : vectors) density.fields.push_back(read::read_vector((*outputs)[i].file, name));
    return density;
  };
  return drawable;
}

Drawable frames_to_draw(const fs::path& folder) {
  Drawable drawable;
  take_heading(folder, drawable);
  for (std::size_t i = 0; fs::exists(render::film_frame_file(folder, i)); ++i) {
    drawable.times.emplace_back(render::read_film_frame(folder, i).time);
    drawable.numbers.push_back(i);
  }
  drawable.density = [folder](std::size_t i, const std::string& field, const std::vector<std::string>& vectors) {
    DensityGrid density = render::read_film_frame(folder, i).density;
    for (const std::string& name : vectors)
      if (std::none_of(density.fields.begin(), density.fields.end(), [&](const auto& one) { return one.name == name; }))
        throw FileError(fmt::format("the frames in {} have no {}; name it in output.pictures", folder.string(), name));
    if (field != "rho") render::show_field(density, field);
    return density;
  };
  return drawable;
}

Drawable start_to_draw(const fs::path& file) {
  const auto spec = std::make_shared<const Case>(read_case(file, {}, 0).spec);
  if (spec->density.empty())
    throw InputError(fmt::format("{} has no [[density]] that could be drawn: its run starts empty", file.string()));
  Drawable drawable;
  drawable.title = spec->title.empty() ? spec->name : spec->title;
  drawable.date = spec->time.date;
  drawable.label = spec->label;
  drawable.times = {spec->time.at(0)};
  drawable.numbers = {0};
  const auto rho = std::shared_ptr<const InitialDensity>(make_density(*spec));
  drawable.density = [spec, rho](std::size_t, const std::string& field, const std::vector<std::string>& vectors) {
    if (field != "rho")
      throw CommandLineError(
          fmt::format("--field {}: of a case only the density at the start is drawn; run it", field));
    DensityGrid density{lattice_of_moments(evaluation_lattice(*spec)), {}};
    const std::size_t count = density.lattice.size();
    const auto d = static_cast<std::size_t>(density.lattice.dimension);
    std::vector<double> axes(count * d);
    fill_coordinates(density.lattice, count, axes.data(), [](std::size_t i) { return i; });
    PointsView points{density.lattice.dimension, count, {}};
    for (std::size_t k = 0; k < d; ++k) points.axis[k] = axes.data() + k * count;
    density.rho.assign(count, 0.0);
    rho->add(points, density.rho.data());
    if (vectors.empty()) return density;
    OutputSpec wanted;
    for (const std::string& name : vectors) wanted.fields.push_back(find_grid_field(name).about);
    density.fields = fields_on_grid(wanted, density.lattice, {{}, density.lattice.points}, {},
                                    make_velocity(*spec)->shown(), spec->time.at(0), 0);
    return density;
  };
  return drawable;
}

}  // namespace gaussdrift::cli
