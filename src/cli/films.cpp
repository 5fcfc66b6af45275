#include "cli/films.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/printable.hpp"
#include "base/seam.hpp"
#include "base/shell_word.hpp"
#include "cli/terminal.hpp"
#include "gaussdrift/error.hpp"
#include "render/animation.hpp"
#include "render/picture.hpp"

namespace gaussdrift::cli {

namespace fs = std::filesystem;

void refuse_films_without_their_program(const Case& spec) {
  if (!spec.output.animation) return;
  const std::string& kind = spec.output.animation->kind;
  if (const std::string why = render::find_film_kind(kind).missing(); !why.empty())
    throw InputError(fmt::format("output.animation = \"{}\": {}; animation = \"{}\" needs no other program", kind, why,
                                 render::film_kinds().front().about.name));
}

std::vector<std::string> film_names(const Case& spec) {
  std::vector<std::string> names;
  if (!spec.output.animation) return names;
  const render::FilmKind& kind = render::find_film_kind(spec.output.animation->kind);
  for (const std::string& array : render::film_arrays(spec))
    for (const render::Style* style : render::film_styles(spec))
      names.push_back("images/" + film_name(*style, array, kind));
  return names;
}

std::string make_films(const fs::path& folder, const Case& spec, int threads, OwedFiles& owed) {
  if (!spec.output.animation || !render::has_film_frames(folder)) return "";
  const std::string remedy =
      fmt::format("the frames are kept: gaussdrift render {} --animation makes it", base::shell_word(folder.string()));
  try {
    const std::vector<std::string> names = render::make_films_of_run(folder, spec, threads);
    return fmt::format("film   {}\n", base::printable(fmt::format("{}", fmt::join(names, ", "))));
  } catch (const base::Abandoned&) {
    return fmt::format("film   not made, because the program was stopped; {}\n", base::printable(remedy));
  } catch (const Error& error) {
    owed.miss(fmt::format("there is no animation: {}; {}", error.what(), remedy));
  }
  return "";
}

}  // namespace gaussdrift::cli
