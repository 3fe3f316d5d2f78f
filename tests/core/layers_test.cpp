// SPDX-License-Identifier: BSL-1.0
// Includes go only downwards, in no circle, and every header begins as the house wants it.
#include <filesystem>
#include <fstream>
#include <regex>
#include <set>

namespace {

using texts = std::map<std::string, std::string>;  // by path below include/nysalt

/// Folders, with a slash, and concepts at the top, by their names without .hpp; from the lowest layer to the
/// highest.
const std::vector<std::vector<std::string>> layers{
    {"core/", "scalar", "scalars/", "phase_point"},
    {"system", "local_system", "force", "energy", "lanes", "bath", "noise", "divergence", "systems/",
     "noises/"},
    {"flow", "flows/", "letters", "word", "stepping/", "stepper"},
    {"kernels/", "model"},
    {"langevin", "family", "families/", "method", "methods/", "integrate"},
    {"atomic_file", "communicator", "communicators/", "execution", "shard", "parallel/"},
    {"derivatives/"},
    {"reference", "references/", "ensemble", "initial_states", "ensembles/"},
    {"distributed_run", "integrate_ensemble", "ensemble_run", "flow_map_data"},
    {"losses/"},
    {"judgement", "learning/", "learn"},
    {"analysis/"},
    {"hmc"},
    {"version", "export_to", "system_declaration", "plugin", "comparison_options", "compare", "recommend"},
    {"core", "analyse", "parallel"},
    {"odeint", "mpi", "nysalt"}};

int layer_of(const std::string& path) {
  const auto slash = path.find('/');
  const auto name = slash == std::string::npos ? path.substr(0, path.rfind('.')) : path.substr(0, slash + 1);
  const auto has = [&](const auto& layer) { return std::ranges::find(layer, name) != layer.end(); };
  const auto found = std::ranges::find_if(layers, has);
  return found == layers.end() ? -1 : static_cast<int>(found - layers.begin());
}

/// What stands at the first group of a regex, in lines of the preprocessor: others are not searched, as that
/// takes seconds.
std::set<std::string> found_in(const std::string& text, const std::regex& names) {
  std::set<std::string> result;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    std::smatch found;
    if (line.starts_with('#') && std::regex_search(line, found, names)) result.insert(found[1]);
  }
  return result;
}

std::set<std::string> includes_of(const std::string& text) {
  static const std::regex ours(R"re(#\s*include\s*["<]nysalt/([^">]+)[">])re");
  return found_in(text, ours);
}

/// What it includes of others than us, the standard library and Eigen. The standard's names have no dot, and
/// what the compiler brings along is its own.
std::set<std::string> libraries_of(const std::string& text) {
  static const std::regex theirs(
      R"re(#\s*include\s*["<](?!nysalt/|Eigen/|immintrin\.h)([^">]*[./][^">]*)[">])re");
  return found_in(text, theirs);
}

/// All that it includes, by whatever includes it.
std::set<std::string> reached_from(const texts& files, const std::string& path,
                                   std::set<std::string> all = {}) {
  if (!files.contains(path)) return all;
  for (const auto& next : includes_of(files.at(path))) {
    if (all.insert(next).second) all = reached_from(files, next, std::move(all));
  }
  return all;
}

/// Every breach, in words.
std::vector<std::string> breaches(const texts& files) {
  std::vector<std::string> found;
  for (const auto& [path, text] : files) {
    if (layer_of(path) < 0) found.push_back(path + " belongs to no layer");
    for (const auto& other : includes_of(text)) {
      if (!files.contains(other)) found.push_back(path + " includes " + other + ", which is not there");
      if (layer_of(other) > layer_of(path))
        found.push_back(path + " includes " + other + ", which is above it");
    }
    if (reached_from(files, path).contains(path)) found.push_back(path + " includes itself");
    if (!text.starts_with("// SPDX-License-Identifier: BSL-1.0\n"))
      found.push_back(path + " has no licence line");
    if (text.find("\n#pragma once\n") == std::string::npos) found.push_back(path + " has no #pragma once");
  }
  return found;
}

texts files_below(const std::filesystem::path& folder) {
  namespace fs = std::filesystem;
  const fs::path root = fs::path(NYSALT_SOURCE_DIR) / folder;
  texts files;
  for (const auto& entry : fs::recursive_directory_iterator(root)) {
    if (!entry.is_regular_file() || entry.path().extension() == ".h") continue;  // c_force.h is for C
    std::ostringstream text;
    text << std::ifstream(entry.path()).rdbuf();
    files[fs::relative(entry.path(), root).generic_string()] = text.str();
  }
  return files;
}

const texts headers = files_below("include/nysalt");

/// Every folder that reaches itself through the includes of other folders. Concepts at the top belong to no
/// folder: they have the layer of their models.
std::vector<std::string> folders_in_a_circle(const texts& files) {
  std::map<std::string, std::set<std::string>> includes;
  for (const auto& [path, text] : files) {
    const auto folder = [](const std::string& of) { return of.substr(0, of.find('/') + 1); };
    for (const auto& other : includes_of(text)) {
      if (!folder(path).empty() && !folder(other).empty() && folder(other) != folder(path))
        includes[folder(path)].insert(folder(other));
    }
  }
  std::vector<std::string> found;
  for (const auto& [folder, direct] : includes) {
    std::set<std::string> reached;
    std::vector<std::string> next(direct.begin(), direct.end());
    while (!next.empty()) {
      const std::string one = next.back();
      next.pop_back();
      if (!reached.insert(one).second || !includes.contains(one)) continue;
      next.insert(next.end(), includes.at(one).begin(), includes.at(one).end());
    }
    if (reached.contains(folder)) found.push_back(folder);
  }
  return found;
}

/// The folders of src, from the lowest to the highest.
const std::vector<std::string> folders{"nysalt", "comparison", "report", "plugin", "program"};

/// Every source that includes one of a higher folder, in words. What is named by a path from src begins with
/// the folder; files of the same folder are named without it.
std::vector<std::string> upward_includes(const texts& sources) {
  static const std::regex ours(R"re(#\s*include\s*"(?:\.\./)*([a-z_]+)/[^"]+")re");
  const auto height = [](const std::string& folder) {
    const auto at = std::ranges::find(folders, folder);
    return at == folders.end() ? -1 : static_cast<int>(at - folders.begin());
  };
  std::vector<std::string> found;
  for (const auto& [path, text] : sources) {
    const std::string folder = path.substr(0, path.find('/'));
    if (path.ends_with(".cpp") || path.ends_with(".hpp")) {
      if (height(folder) < 0) found.push_back(path + " belongs to no folder");
      for (const auto& other : found_in(text, ours)) {
        if (height(other) > height(folder)) found.push_back(path + " includes files of " + other);
      }
    }
  }
  return found;
}

const std::string head = "// SPDX-License-Identifier: BSL-1.0\n#pragma once\n";

}  // namespace

BOOST_AUTO_TEST_CASE(the_house_stands) {
  BOOST_TEST(headers.size() > 40U);
  for (const auto& breach : breaches(headers)) BOOST_ERROR(breach);
}

BOOST_AUTO_TEST_CASE(a_cellar_that_includes_the_roof_is_found) {
  const texts sound{{"scalar.hpp", head}, {"method.hpp", head + "#include \"nysalt/scalar.hpp\"\n"}};
  BOOST_TEST(breaches(sound).empty());
  const std::vector<std::pair<std::string, texts>> planted{
      {"above", {{"scalar.hpp", head + "#include \"nysalt/method.hpp\"\n"}, {"method.hpp", head}}},
      {"itself",
       {{"systems/a.hpp", head + "# include <nysalt/systems/b.hpp>\n"},
        {"systems/b.hpp", head + "#include \"nysalt/systems/a.hpp\"\n"}}},
      {"no layer", {{"cellar.hpp", head}}},
      {"no layer", {{"cellar/a.hpp", head}}},
      {"not there", {{"scalar.hpp", head + "#include \"nysalt/gone.hpp\"\n"}}},
      {"licence", {{"scalar.hpp", "#pragma once\n"}}},
      {"pragma", {{"scalar.hpp", "// SPDX-License-Identifier: BSL-1.0\n"}}}};
  for (const auto& [words, files] : planted) {
    const auto found = breaches(files);
    BOOST_TEST(
        std::ranges::any_of(found, [&words = words](const auto& one) { return one.find(words) != one.npos; }),
        words);
  }
}

BOOST_AUTO_TEST_CASE(folders_include_each_other_one_way) {
  for (const auto& folder : folders_in_a_circle(headers))
    BOOST_ERROR(folder + " includes itself through others");
  const texts circle{{"flows/a.hpp", "#include \"nysalt/systems/b.hpp\"\n"},
                     {"systems/b.hpp", "#include \"nysalt/noises/c.hpp\"\n"},
                     {"noises/c.hpp", "#include \"nysalt/flows/a.hpp\"\n"}};
  BOOST_TEST(folders_in_a_circle(circle).size() == 3U);
}

// Of the library, of what needs Boost.Odeint or MPI, of comparisons, and of systems of the program.
BOOST_AUTO_TEST_CASE(every_header_is_reached_from_an_entry_header) {
  const std::set<std::string> entries{"nysalt.hpp",  "odeint.hpp",    "mpi.hpp",
                                      "compare.hpp", "recommend.hpp", "plugin.hpp"};
  auto reached = entries;
  for (const auto& entry : entries) reached.merge(reached_from(headers, entry));
  for (const auto& [path, text] : headers) BOOST_TEST(reached.contains(path), path);
  BOOST_TEST(!reached_from(headers, "core.hpp").contains("hmc.hpp"));
}

BOOST_AUTO_TEST_CASE(sources_include_downwards) {
  const auto sources = files_below("src");
  BOOST_TEST(sources.size() > 200U);
  for (const auto& breach : upward_includes(sources)) BOOST_ERROR(breach);
  BOOST_TEST(upward_includes({{"report/a.cpp", "#include \"program/output.hpp\"\n"}}).size() == 1U);
  BOOST_TEST(upward_includes({{"program/commands/a.cpp", "#include \"../output.hpp\"\n"}}).empty());
  BOOST_TEST(upward_includes({{"attic/a.cpp", ""}}).size() == 1U);
}

// What is dear to parse is for the sources in src/nysalt, and what steps needs Eigen alone.
BOOST_AUTO_TEST_CASE(headers_include_eigens_core_at_most) {
  const auto is_of_others = [](const std::string& path) {
    return path.starts_with("references/odeint") || path == "communicators/mpi.hpp";
  };
  static const std::regex of_eigen(R"re(#\s*include\s*["<](Eigen/[^">]*)[">])re");
  for (const auto& [path, text] : headers) {
    if (is_of_others(path)) continue;
    auto found = libraries_of(text);
    found.merge(found_in(text, of_eigen));
    found.erase("Eigen/Core");
    found.erase("cxxabi.h");  // of the compiler
    for (const auto& library : found) BOOST_ERROR(path + " includes " + library);
  }
  for (const auto& path : reached_from(headers, "core.hpp")) BOOST_TEST(!is_of_others(path), path);
  BOOST_TEST(found_in("#include <Eigen/Dense>\n", of_eigen).contains("Eigen/Dense"));
  const auto found =
      libraries_of("# include <fmt/format.h>\n#include <vector>\n#include <mpi.h>\n#include <Eigen/Core>\n");
  BOOST_TEST((found == std::set<std::string>{"fmt/format.h", "mpi.h"}));
}
