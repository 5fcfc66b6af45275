// [output.pictures]: how pictures look; and the keys of [output] about the animation.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/catalogue.hpp"
#include "base/has_one.hpp"
#include "input/tables/tables.hpp"
#include "render/colour.hpp"
#include "render/film.hpp"
#include "render/styles.hpp"
#include "sim/grid_fields.hpp"

namespace gaussdrift::input {

namespace {

constexpr const char* table_name = "output.pictures";
constexpr double least_side = 64, most_side = 16384;

template <class Thing>
std::string meanings(std::string_view meaning, const std::vector<Thing>& things) {
  std::string text(meaning);
  for (const Thing& thing : things) text += fmt::format(". `{}`: {}", thing.about.name, thing.about.meaning);
  return text;
}

/// As many numbers as wanted; nothing after a complaint.
std::optional<std::vector<double>> numbers_of(Reader& in, std::string_view table, std::string_view name,
                                              std::size_t count, std::string_view what) {
  const Entry* entry = in.find(table, name);
  if (!entry) return std::nullopt;
  auto list = in.numbers(*entry, find_key(table, name));
  if (list && list->size() != count) {
    in.diagnostics.error(entry->value.place,
                         fmt::format("{}.{} has {} numbers; it needs {}: {}", table, name, list->size(), count, what));
    return std::nullopt;
  }
  return list;
}

void complain(Reader& in, std::string_view table, std::string_view name, const std::string& what,
              const std::string& remedy = "") {
  if (const Entry* entry = in.find(table, name)) in.diagnostics.error(entry->value.place, what, remedy);
}

/// Width and height in whole pixels.
void read_size(Reader& in, std::string_view table, std::string_view name, std::array<int, 2>& size) {
  const auto list = numbers_of(in, table, name, 2, "width and height in pixels");
  if (!list) return;
  for (std::size_t k = 0; k < 2; ++k) {
    const double side = (*list)[k];
    if (side != std::floor(side) || side < least_side || side > most_side)
      return complain(in, table, name,
                      fmt::format("{}.{}: {} is not a whole number of pixels from {} to {}", table, name, side,
                                  least_side, most_side));
    size[k] = static_cast<int>(side);
  }
}

void read_range(Reader& in, PicturesSpec& pictures) {
  const auto list = numbers_of(in, table_name, "range", 2, "the lower and the upper end");
  if (!list) return;
  if (!((*list)[0] < (*list)[1]))
    return complain(in, table_name, "range",
                    fmt::format("output.pictures.range goes from {} to {}, which is no range", (*list)[0], (*list)[1]));
  if (pictures.log && (*list)[0] <= 0)
    return complain(
        in, table_name, "range",
        fmt::format("output.pictures.range begins at {}, and a logarithm needs numbers above 0", (*list)[0]),
        "range = [1e-6, 1], or leave log out");
  pictures.range = {(*list)[0], (*list)[1]};
}

void read_zoom(Reader& in, PicturesSpec& pictures, const Domain& domain) {
  if (!in.facts.dimension || !in.facts.domain_valid) return;
  const auto d = static_cast<std::size_t>(domain.dimension);
  const auto list = numbers_of(in, table_name, "zoom", 2 * d, "the lower and the upper end along each axis");
  if (!list) return;
  for (std::size_t k = 0; k < d; ++k) {
    const double low = (*list)[2 * k], high = (*list)[2 * k + 1];
    if (!(low < high) || low < domain.min[k] || high > domain.max[k])
      return complain(in, table_name, "zoom",
                      fmt::format("output.pictures.zoom goes from {} to {} along {}; the domain has {} to {}", low,
                                  high, std::string(1, "xyz"[k]), domain.min[k], domain.max[k]));
  }
  pictures.zoom = *list;
}

void read_view(Reader& in, PicturesSpec& pictures) {
  const auto list = numbers_of(in, table_name, "view", 2, "azimuth and elevation of the eye in degrees");
  if (!list) return;
  if ((*list)[1] < 5 || (*list)[1] > 85)
    return complain(
        in, table_name, "view",
        fmt::format("output.pictures.view has the elevation {}; it lies between 5 and 85 degrees", (*list)[1]));
  pictures.view = {(*list)[0], (*list)[1]};
}

/// Fields are there for pictures where outputs have them, in density files.
void check_field(Reader& in, const OutputSpec& output, std::string_view key, std::string_view needed) {
  if (needed.empty()) return;
  const bool has_it = std::any_of(output.fields.begin(), output.fields.end(),
                                  [&](const GridField& field) { return field.name == needed; });
  if (!has_it)
    complain(in, table_name, key,
             fmt::format("output.pictures.{} shows the {}, which output.fields does not name", key, needed),
             fmt::format("fields = [\"{}\"] in [output]", needed));
  else if (!base::has_one(output.files, &OutputFile::shows_density))
    complain(
        in, table_name, key,
        fmt::format("output.pictures.{} shows the {}, which density files keep, and none are written", key, needed),
        "have \"density\" in output.vtk");
}

std::vector<std::string_view> drawable_fields() {
  std::vector<std::string_view> names;
  for (const GridFieldKind& kind : grid_fields())
    if (kind.about.is_on_grid && !kind.about.is_matrix && kind.about.name != "rho") names.push_back(kind.about.name);
  return names;
}

void check_velocity(Reader& in, const OutputSpec& output) {
  if (output.pictures.velocity.empty()) return;
  const bool is_shown = std::any_of(output.images.begin(), output.images.end(), [](const PictureStyle& style) {
    return render::find_style(style.name).takes_velocity;
  });
  if (!is_shown || in.facts.dimension == 3)
    complain(in, table_name, "velocity", "the velocity is drawn over maps in 2D, and output.images names none",
             "images = [\"heatmap\"]");
  check_field(in, output, "velocity", "velocity");
}

}  // namespace

std::vector<Key> animation_keys() {
  return {{.name = "animation",
           .type = Type::choice,
           .choices = base::names_of(render::film_kinds()),
           .or_flag = true,
           .meaning = meanings("the pictures of the run in motion, in images/. `true` is the first of these",
                               render::film_kinds())},
          {.name = "animation_frames",
           .type = Type::whole,
           .fallback = "200",
           .range = {2, 10000},
           .meaning = "frames of the animation, evenly spaced from `time.start` to `time.end`. Steps end on them"},
          {.name = "animation_seconds",
           .type = Type::number,
           .fallback = "10",
           .range = {0.1, 3600},
           .unit = "s",
           .meaning = "how long the animation is"},
          {.name = "animation_size",
           .type = Type::numbers,
           .range = {least_side, most_side},
           .unit = "pixel",
           .meaning = "width and height of the animation. The default is [640, 480], and [1280, 960] for `mp4` and "
                      "`webm`. Odd numbers "
                      "get one more"}};
}

Section pictures_section() {
  return {
      Table{.name = table_name,
            .required = false,
            .meaning =
                "how pictures look, and the frames of an animation. `gaussdrift render` has options of these names"},
      {{.name = "range",
        .type = Type::numbers,
        .meaning = "lower and upper end of the colours. Without it the range of the first picture, with round ends; "
                   "where values leave that, of all pictures"},
       {.name = "log",
        .type = Type::boolean,
        .meaning = "colours, heights and lines by the logarithm. Values that are not positive get the lowest colour"},
       {.name = "per_frame",
        .type = Type::boolean,
        .meaning =
            "a range of its own for each picture. Then pictures of different times cannot be compared by colour"},
       {.name = "size",
        .type = Type::numbers,
        .range = {least_side, most_side},
        .unit = "pixel",
        .meaning = "width and height of pictures, [1280, 960] by default"},
       {.name = "colour_map",
        .type = Type::choice,
        .choices = base::names_of(render::colour_maps()),
        .meaning = meanings("the colours, instead of those of the style", render::colour_maps())},
       {.name = "field",
        .type = Type::choice,
        .choices = drawable_fields(),
        .meaning = "one of `output.fields`, drawn in place of the density; of vectors the length"},
       {.name = "view",
        .type = Type::numbers,
        .unit = "degree",
        .meaning = "azimuth and elevation of the eye for pictures in perspective, [-62, 31] by default. 0 degrees is "
                   "the direction of x"},
       {.name = "zoom",
        .type = Type::numbers,
        .unit = "length",
        .meaning = "a part of the domain: [x_min, x_max, y_min, y_max], and in space z_min and z_max"},
       {.name = "velocity",
        .type = Type::choice,
        .choices = base::names_of(render::velocity_styles()),
        .meaning = meanings("the velocity over maps in 2D, `heatmap` and `error`", render::velocity_styles())},
       {.name = "transparent", .type = Type::boolean, .meaning = "no background; animations keep theirs"},
       {.name = "large_type",
        .type = Type::boolean,
        .meaning = "letters, lines and margins half as large again, for slides"}}};
}

void read_animation(Reader& in, OutputSpec& output) {
  const Entry* entry = in.find("output", "animation");
  AnimationSpec animation;
  if (const auto number = in.number("output", "animation_frames")) animation.frames = to_int(*number);
  if (const auto number = in.number("output", "animation_seconds")) animation.seconds = number->number;
  read_size(in, "output", "animation_size", animation.size);
  if (!entry) {
    for (const char* key : {"animation_frames", "animation_seconds", "animation_size"})
      complain(in, "output", key, fmt::format("output.{} is there, and no animation is made", key), "animation = true");
    return;
  }
  if (entry->value.kind == Value::Kind::boolean) {
    if (!entry->value.boolean) return;
    animation.kind = render::film_kinds().front().about.name;
  } else {
    const Key& key = find_key("output", "animation");
    const auto choice = in.choice_in(entry->value, key, in.label_of(key));
    if (!choice) return;
    animation.kind = key.choices[*choice];
  }
  if (in.facts.end && *in.facts.end == 0)
    return complain(in, "output", "animation", "output.animation: time.end = time.start leaves nothing to move",
                    "leave it out");
  output.animation = std::move(animation);
}

void read_pictures(Reader& in, OutputSpec& output, const Domain& domain) {
  if (!in.table(table_name)) return;
  PicturesSpec& pictures = output.pictures;
  pictures.log = in.flag(table_name, "log");
  pictures.per_frame = in.flag(table_name, "per_frame");
  pictures.transparent = in.flag(table_name, "transparent");
  pictures.large_type = in.flag(table_name, "large_type");
  pictures.colour_map = in.choice(table_name, "colour_map");
  pictures.field = in.choice(table_name, "field");
  pictures.velocity = in.choice(table_name, "velocity");
  read_size(in, table_name, "size", pictures.size);
  read_range(in, pictures);
  read_zoom(in, pictures, domain);
  read_view(in, pictures);
  if (pictures.range && pictures.per_frame)
    complain(in, table_name, "per_frame",
             "output.pictures.range is one range for all pictures, and per_frame wants many", "leave one of them out");
  check_field(in, output, "field", pictures.field);
  check_velocity(in, output);
}

void write_animation(Writer& out, const OutputSpec& output) {
  if (!output.animation) return;
  const AnimationSpec &animation = *output.animation, usual;
  out.entry("animation", written(animation.kind));
  if (animation.frames != usual.frames) out.entry("animation_frames", fmt::format("{}", animation.frames));
  if (animation.seconds != usual.seconds) out.entry("animation_seconds", written(animation.seconds));
  if (animation.size != usual.size)
    out.entry("animation_size", fmt::format("[{}, {}]", animation.size[0], animation.size[1]));
}

void write_pictures(Writer& out, const PicturesSpec& pictures) {
  const PicturesSpec usual;
  if (pictures == usual) return;
  const auto pair = [](const std::array<double, 2>& both) { return written(std::vector<double>{both[0], both[1]}); };
  out.table(table_name);
  if (pictures.range) out.entry("range", pair(*pictures.range));
  const auto flag = [&](const char* name, bool value) {
    if (value) out.entry(name, "true");
  };
  flag("log", pictures.log);
  flag("per_frame", pictures.per_frame);
  if (pictures.size != usual.size) out.entry("size", fmt::format("[{}, {}]", pictures.size[0], pictures.size[1]));
  const auto text = [&](const char* name, const std::string& value) {
    if (!value.empty()) out.entry(name, written(value));
  };
  text("colour_map", pictures.colour_map);
  text("field", pictures.field);
  if (pictures.view != usual.view) out.entry("view", pair(pictures.view));
  if (!pictures.zoom.empty()) out.entry("zoom", written(pictures.zoom));
  text("velocity", pictures.velocity);
  flag("transparent", pictures.transparent);
  flag("large_type", pictures.large_type);
}

}  // namespace gaussdrift::input
