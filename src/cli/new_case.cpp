// gaussdrift new: the built-in examples, listed or written.
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "base/suggest.hpp"
#include "cli/laid_out.hpp"
#include "cli/terminal.hpp"
#include "cli/verbs.hpp"
#include "gaussdrift/read_case.hpp"
#include "input/examples.hpp"
#include "write/atomic_file.hpp"

namespace gaussdrift::cli {

namespace fs = std::filesystem;

namespace {

struct NewOptions {
  std::string name;              // empty: a list
  std::filesystem::path folder;  // --out; empty: here
  bool force = false;
  bool json = false;
};

void declare(OptionList& options, NewOptions& given) {
  options.add("name", given.name, "NAME", "the case to write. Without it, a list");
  options.add("--out", given.folder, "DIR", "folder for the file; this one by default");
  options.flag("--force", given.force, "replace a file of that name");
  options.json(given.json);
}

bool is_case(const input::ExampleFile& file) { return fs::path(file.name).extension() == ".toml"; }

std::string name_of(const input::ExampleFile& file) { return fs::path(file.name).stem().string(); }

/// The "[case] title" of a case. The text is not read as a case: it may need a file that is not there.
std::string title_of(std::string_view text) {
  const std::size_t at = text.find("\ntitle");
  const std::size_t open = at == std::string_view::npos ? at : text.find('"', at);
  const std::size_t close = open == std::string_view::npos ? open : text.find('"', open + 1);
  return close == std::string_view::npos ? "" : std::string(text.substr(open + 1, close - open - 1));
}

void list_examples(bool json) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const input::ExampleFile& file : input::example_files())
    if (is_case(file)) list.push_back({{"name", name_of(file)}, {"title", title_of(file.bytes)}});
  if (json) {
    say("{}\n", list.dump(2));
    return;
  }
  say("Built-in cases. gaussdrift new NAME writes one as NAME.toml:\n");
  for (const auto& entry : list)
    say("  {:<18} {}\n", entry["name"].get<std::string>(), entry["title"].get<std::string>());
}

ExitCode new_case(const NewOptions& options) {
  if (options.name.empty()) {
    list_examples(options.json);
    return ExitCode::ok;
  }
  const std::string wanted =
      fs::path(options.name).extension() == ".toml" ? fs::path(options.name).stem().string() : options.name;
  std::vector<const input::ExampleFile*> files;  // the case, and the data beside it
  std::vector<std::string> names;
  for (const input::ExampleFile& file : input::example_files()) {
    if (is_case(file)) names.push_back(name_of(file));
    // The case, and what it names: data of the same name, and of that name and a number.
    const std::string name = name_of(file);
    const bool numbered = name.size() > wanted.size() + 1 && name.compare(0, wanted.size() + 1, wanted + "_") == 0 &&
                          name.find_first_not_of("0123456789", wanted.size() + 1) == std::string::npos;
    if (name == wanted || numbered) files.push_back(&file);
  }
  if (std::find(names.begin(), names.end(), wanted) == names.end()) {
    const auto near = base::suggest(wanted, names);
    throw CommandLineError(fmt::format("there is no built-in case \"{}\"{}; gaussdrift new lists them", wanted,
                                       near ? fmt::format("; did you mean \"{}\"?", *near) : ""));
  }
  for (const input::ExampleFile* file : files)
    if (const fs::path path = options.folder / file->name; fs::exists(path) && !options.force)
      throw FileError(fmt::format("{} exists; --force replaces it", path.string()));
  std::error_code failure;
  if (!options.folder.empty() && (fs::create_directories(options.folder, failure), failure))
    throw FileError(fmt::format("the folder {} cannot be made: {}", options.folder.string(), failure.message()));
  nlohmann::ordered_json written = nlohmann::ordered_json::array();
  write::remove_what_killed_processes_left(options.folder.empty() ? "." : options.folder);
  for (const input::ExampleFile* file : files) {
    const fs::path path = options.folder / file->name;
    write::write_text(path, file->bytes);
    written.push_back(path.string());
    if (!options.json) say("wrote  {}\n", path.string());
  }
  if (options.json)
    say("{}\n", laid_out({{"written", written}}));
  else
    say("next   gaussdrift run {}\n", (options.folder / (wanted + ".toml")).string());
  return ExitCode::ok;
}

}  // namespace

Verb new_verb() {
  return make_verb<NewOptions>("new", "list the built-in cases, or write one to start from", declare, new_case);
}

}  // namespace gaussdrift::cli
