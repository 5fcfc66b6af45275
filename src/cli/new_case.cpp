// gaussdrift new: the built-in examples, listed or written, with other values if they are wanted; or a case to fill in.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "base/suggest.hpp"
#include "cli/asked_case.hpp"
#include "cli/example_topics.hpp"
#include "cli/laid_out.hpp"
#include "cli/terminal.hpp"
#include "cli/verbs.hpp"
#include "gaussdrift/read_case.hpp"
#include "input/blank_case.hpp"
#include "input/edit_case.hpp"
#include "write/atomic_file.hpp"

namespace gaussdrift::cli {

namespace fs = std::filesystem;

namespace {

struct NewOptions {
  std::string name;                   // empty: a list, or with `blank` a name of its own
  std::string blank;                  // "2d", "3d"; empty: none
  std::string topic;                  // --list; "true": all
  std::vector<std::string> settings;  // --set
  std::filesystem::path folder;       // --out; empty: here
  bool force = false;
  bool json = false;
};

std::vector<std::string> example_names() {
  std::vector<std::string> names;
  for (const Example& example : examples()) names.push_back(example.name);
  return names;
}

std::vector<std::string> dimensions() { return {"2d", "3d"}; }

void declare(OptionList& options, NewOptions& given) {
  const Option name =
      options.add("name", given.name, "NAME", "the case to write. Without it, a list").offers(example_names);
  options
      .add("--list", given.topic, "TOPIC",
           "list the cases by what they show; with a word, those that show it: --list diffusion")
      .value_optional()
      .excludes(name);
  options
      .add("--blank", given.blank, "DIMENSIONS",
           "a case to fill in, with comments: 2d or 3d. Its file is scene.toml, or has the name that is given")
      .offers(dimensions);
  options.add("--set", given.settings, "KEY=VALUE", "write another value of a key: --set time.step=0.01. Repeatable")
      .repeatable()
      .offers(settings_to_begin);
  options.add("--out", given.folder, "DIR", "folder for the file; this one by default");
  options.flag("--force", given.force, "replace a file of that name");
  options.json(given.json);
}

void list_examples(const NewOptions& options) {
  const std::vector<Example> shown = examples_about(options.topic == "true" ? "" : options.topic);
  if (options.json) {
    nlohmann::ordered_json list = nlohmann::ordered_json::array();
    for (const Example& example : shown)
      list.push_back({{"name", example.name}, {"title", example.title}, {"shows", example.topic}});
    say("{}\n", list.dump(2));
    return;
  }
  say("Built-in cases, by what they show. gaussdrift new NAME writes one as NAME.toml:\n");
  std::string topic;
  for (const Example& example : shown) {
    if (example.topic != topic) say("\n{}\n", topic = example.topic);
    say("  {:<18} {}\n", example.name, example.title);
  }
}

struct NewFile {
  fs::path path;
  std::string bytes;
};

/// Of the example, and of the data beside it.
std::vector<NewFile> files_of_example(const std::string& wanted, const fs::path& folder) {
  const std::vector<std::string> names = example_names();
  if (std::find(names.begin(), names.end(), wanted) == names.end()) {
    const auto near = base::suggest(wanted, names);
    throw CommandLineError(fmt::format("there is no built-in case \"{}\"{}; gaussdrift new lists them", wanted,
                                       near ? fmt::format("; did you mean \"{}\"?", *near) : ""));
  }
  std::vector<NewFile> files;
  for (const input::ExampleFile* file : files_of(wanted))
    files.push_back({folder / file->name, std::string(file->bytes)});
  return files;
}

std::vector<NewFile> blank_file(const NewOptions& options, const std::string& name) {
  const std::vector<std::string> known = dimensions();
  const auto found = std::find(known.begin(), known.end(), options.blank);
  if (found == known.end())
    throw CommandLineError(fmt::format("--blank is {}, not \"{}\"", fmt::join(known, " or "), options.blank));
  return {{options.folder / (name + ".toml"), input::blank_case(found == known.begin() ? 2 : 3)}};
}

/// Files that were written, and go away again unless they are kept.
class WrittenFiles {
 public:
  ~WrittenFiles() {
    std::error_code ignored;
    for (const fs::path& path : made_) fs::remove(path, ignored);
  }
  void write(const NewFile& file) {
    const bool is_new = !fs::exists(file.path);
    write::write_text(file.path, file.bytes);
    if (is_new) made_.push_back(file.path);
  }
  void keep() { made_.clear(); }

 private:
  std::vector<fs::path> made_;
};

/// The data come first, because the case is read where it has other values, and data with it.
void write_files(std::vector<NewFile>& files, const std::vector<std::string>& settings) {
  WrittenFiles written;
  for (const bool cases : {false, true})
    for (NewFile& file : files) {
      if ((file.path.extension() == ".toml") != cases) continue;
      if (cases && !settings.empty()) {
        for (const std::string& warning : parse_case(file.bytes, file.path, settings).warnings) note("{}\n", warning);
        file.bytes = input::with_settings(file.bytes, settings);
      }
      written.write(file);
    }
  written.keep();
}

ExitCode new_case(const NewOptions& options) {
  if (options.name.empty() && options.blank.empty()) {
    if (!options.settings.empty())
      throw CommandLineError("--set needs a NAME, or --blank; gaussdrift new lists the cases");
    list_examples(options);
    return ExitCode::ok;
  }
  const std::string name =
      fs::path(options.name).extension() == ".toml" ? fs::path(options.name).stem().string() : options.name;
  std::vector<NewFile> files = options.blank.empty() ? files_of_example(name, options.folder)
                                                     : blank_file(options, name.empty() ? "scene" : name);
  for (const NewFile& file : files)
    if (fs::exists(file.path) && !options.force)
      throw FileError(fmt::format("{} exists; --force replaces it", file.path.string()));
  std::error_code failure;
  if (!options.folder.empty() && (fs::create_directories(options.folder, failure), failure))
    throw FileError(fmt::format("the folder {} cannot be made: {}", options.folder.string(), failure.message()));
  write::remove_what_killed_processes_left(options.folder.empty() ? "." : options.folder);
  write_files(files, options.settings);
  nlohmann::ordered_json written = nlohmann::ordered_json::array();
  std::string scene;
  for (const NewFile& file : files) {
    written.push_back(file.path.string());
    if (file.path.extension() == ".toml") scene = file.path.string();
    if (!options.json) say("wrote  {}\n", file.path.string());
  }
  if (options.json)
    say("{}\n", laid_out({{"written", written}}));
  else
    say("next   gaussdrift run {}\n", scene);
  return ExitCode::ok;
}

}  // namespace

Verb new_verb() {
  return make_verb<NewOptions>("new", "list the built-in cases, or write one to start from", declare, new_case);
}

}  // namespace gaussdrift::cli
