// gaussdrift render: the densities of a run, drawn again.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <vector>

#include "base/suggest.hpp"
#include "cli/laid_out.hpp"
#include "cli/output_name.hpp"
#include "cli/outputs_of.hpp"
#include "cli/terminal.hpp"
#include "cli/verbs.hpp"
#include "render/styles.hpp"
#include "write/folder_lock.hpp"
#include "write/result_folder.hpp"
#include "write/run_folder.hpp"

namespace gaussdrift::cli {

namespace fs = std::filesystem;

namespace {

struct RenderOptions {
  fs::path folder;
  std::string style;          // empty: the default of the dimension and field
  std::string field = "rho";  // an array of the density files
  std::vector<double> times;  // empty: all
  fs::path out;               // empty: images/ of the folder
  bool json = false;
};

void declare(OptionList& options, RenderOptions& given) {
  options.add("folder", given.folder, "DIR", "folder of a run, or a .vti or .pvti").required();
  options.add("--style", given.style, "NAME", fmt::format("{}", fmt::join(render::style_names(), ", ")));
  options.add("--field", given.field, "NAME",
              fmt::format("{}; of vectors the length. rho by default", fmt::join(arrays_of_outputs(), ", ")));
  options.add("--times", given.times, "T,...", "only these output times").separated_by(',');
  options.add("--out", given.out, "DIR", "folder for the pictures; images/ of the run by default");
  options.json(given.json);
}

/// The one at a time that was typed, maybe with few digits: the nearest within a thousandth.
std::size_t output_at(double wanted, const std::vector<read::WrittenOutput>& outputs, const fs::path& folder) {
  std::optional<std::size_t> nearest;
  std::vector<double> times;
  for (std::size_t i = 0; i < outputs.size(); ++i) {
    if (!outputs[i].time) continue;
    const double time = *outputs[i].time, apart = std::abs(wanted - time);
    times.push_back(time);
    if (apart <= 1e-3 * std::max(1e-9, std::abs(time)) &&
        (!nearest || apart < std::abs(wanted - *outputs[*nearest].time)))
      nearest = i;
  }
  if (!nearest)
    throw CommandLineError(fmt::format("--times {:g}: no output of {} is within a thousandth of it; there are {:.6g}",
                                       wanted, folder.string(), fmt::join(times, ", ")));
  return *nearest;
}

const render::Style& style_called(const std::string& name) {
  if (const render::Style* style = base::find_or_null(render::styles(), name)) return *style;
  std::vector<std::string> names;
  for (const render::Style& style : render::styles()) names.emplace_back(style.about.name);
  const auto near = base::suggest(name, names);
  throw CommandLineError(fmt::format("--style {} is not known{} there are {}", name,
                                     near ? fmt::format("; did you mean {}?", *near) : ";", fmt::join(names, ", ")));
}

/// Where pictures go: images/ of the run, the folder of --out, or the working folder for a single density. They replace
/// pictures that stand on its list, and no other file.
class Place {
 public:
  /// `drawn`: the folder of the run, which is locked, or a density. Throws FileError.
  Place(const fs::path& drawn, const fs::path& out, const std::vector<std::string>& names) {
    if (!out.empty()) {
      own_.emplace(out, "drawing", write::ResultFolder::Earlier::join);
      own_->claim(names);
      folder_ = out;
    } else if (fs::is_directory(drawn)) {
      std::vector<std::string> in_the_run;
      for (const std::string& name : names) in_the_run.push_back("images/" + name);
      write::add_to_own_files(drawn, in_the_run);
      folder_ = drawn / "images";
    } else {
      for (const std::string& name : names)
        if (std::error_code ignored; fs::exists(fs::symlink_status(name, ignored)))
          throw FileError(fmt::format(
              "{} is there already and would be replaced; move it away, or choose a folder with --out", name));
      folder_ = ".";
    }
  }
  const fs::path& folder() const { return folder_; }
  void complete() {
    if (own_) own_->complete();
  }

 private:
  fs::path folder_;
  std::optional<write::ResultFolder> own_;
};

ExitCode render(const RenderOptions& options) {
  check_folder_name(options.out, "pictures are written into a folder, as surface_0000.png and so on");
  check_array(options.field);
  const bool error = options.field == "error";
  const render::Style* style = options.style.empty() ? nullptr : &style_called(options.style);
  const bool into_the_run = options.out.empty() && fs::is_directory(options.folder);
  std::optional<write::FolderLock> lock;
  if (into_the_run) lock.emplace(options.folder);
  const auto outputs = outputs_of(options.folder, lock.has_value());
  std::set<std::size_t> wanted;
  for (const double time : options.times) wanted.insert(output_at(time, outputs, options.folder));
  for (std::size_t i = 0; options.times.empty() && i < outputs.size(); ++i) wanted.insert(i);
  render::check_available();
  // Read twice, for the range and for the picture: all of a run at once need not fit into memory.
  double low = 0, high = 0;
  int dimension = 2;
  for (const std::size_t i : wanted) {
    const DensityGrid density = read::read_density(outputs[i].file, options.field);
    dimension = density.lattice.dimension;
    for (const double value : density.rho) low = std::min(low, value), high = std::max(high, value);  // not of NaN
  }
  if (!style) style = &render::default_style(dimension, error);
  if (!style->about.shows(dimension))
    throw CommandLineError(
        fmt::format("--style {} does not show densities of {} dimensions", style->about.name, dimension));
  const auto [range_min, range_max] = style->range(low, high);
  std::vector<std::string> names;
  for (const std::size_t i : wanted)
    names.push_back(fmt::format("{}{}_{:04}.png", options.field == "rho" ? "" : options.field + "_", style->about.name,
                                outputs[i].number));
  Place place(options.folder, options.out, names);
  nlohmann::ordered_json written = nlohmann::ordered_json::array();
  const fs::path named = (options.folder / "").parent_path();  // "a/b/" is "a/b"
  auto name = names.begin();
  for (const std::size_t i : wanted) {
    const fs::path png = place.folder() / *name++;
    DensityGrid density = read::read_density(outputs[i].file, options.field);
    if (const std::string needed(style->about.needs_field); !needed.empty())
      density.fields = {read::read_vector(outputs[i].file, needed)};
    draw(*style, density,
         {.title = named.stem().string(),
          .quantity = options.field == "rho" ? "density" : options.field,
          .time = outputs[i].time,
          .range_min = range_min,
          .range_max = range_max},
         png);
    written.push_back(png.string());
    if (!options.json) say("wrote  {}\n", png.string());
  }
  place.complete();
  if (options.json) say("{}\n", laid_out(nlohmann::ordered_json{{"written", written}}));
  return ExitCode::ok;
}

}  // namespace

Verb render_verb() {
  return make_verb<RenderOptions>("render", "draw the densities of a run again, without running it", declare, render);
}

}  // namespace gaussdrift::cli
