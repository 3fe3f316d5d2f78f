// SPDX-License-Identifier: BSL-1.0
#include "program.hpp"

#include <sys/wait.h>

#include <boost/test/unit_test.hpp>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <map>
#include <memory>
#include <set>
#include <stdexcept>
#include <utility>

#include "forged.hpp"
#include "program.hpp"
#include "table.hpp"

#if !defined NYSALT_FAULTS  // where nothing can be preloaded
#define NYSALT_FAULTS ""
#endif
#if defined NYSALT_MPIEXEC  // for any user and any number of cores; Open MPI never frees some of its memory
#define NYSALT_MPIRUN                                                               \
  "env ASAN_OPTIONS=detect_leaks=0 OMPI_ALLOW_RUN_AS_ROOT=1 "                       \
  "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 OMPI_MCA_btl_vader_single_copy_mechanism=none " \
  "OMPI_MCA_mpi_yield_when_idle=1 " NYSALT_MPIEXEC " --oversubscribe --bind-to none -n"
#else
#define NYSALT_MPIRUN ""
#endif
#if defined NYSALT_HAS_HDF5
#define NYSALT_HDF5 "1"
#else
#define NYSALT_HDF5 "0"
#endif

namespace nysalt::test {

namespace fs = std::filesystem;
using json = nlohmann::ordered_json;

finished shell(const scratch& folder, const std::string& line, int limit) {
  const scratch streams(folder.path().filename().string() + "_streams");
  const std::string out = streams / "out";
  const std::string err = streams / "err";
  std::string whole = "cd '" + folder.path().string();
  whole += "' && export nysalt='" NYSALT_PROGRAM "' source='" NYSALT_SOURCE_DIR "/tests/programs";
  whole += "' faults='" NYSALT_FAULTS "' hdf5=" NYSALT_HDF5 " mpirun='" NYSALT_MPIRUN "' && { ";
  whole += line + "\n} </dev/null >'";
  whole += out + "' 2>'";
  whole += err + "'";
  setenv("NYSALT_TEST_LINE", whole.c_str(), 1);  // so that no quote has to be quoted
  const std::string command = "exec timeout " + std::to_string(limit) + " sh -c \"$NYSALT_TEST_LINE\"";
  const int status = std::system(command.c_str());
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, contents(out), contents(err)};
}

finished run(const scratch& folder, const std::string& arguments) {
  return shell(folder, "\"$nysalt\" " + arguments);
}

finished run(const std::string& arguments) { return run(scratch("program"), arguments); }

json json_of(const finished& done) { return json::parse(done.out, nullptr, false); }

namespace {

const std::string source = NYSALT_SOURCE_DIR "/tests/programs/";
using texts = std::vector<std::string>;

bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

/// Removes the beginning of the text, if it is that.
bool takes(std::string& text, const std::string& beginning) {
  const bool is_there = text.starts_with(beginning);
  if (is_there) text.erase(0, beginning.size());
  return is_there;
}

texts split(const std::string& text, const std::string& between) {
  texts parts;
  std::size_t begin = 0;
  for (auto at = text.find(between); at != std::string::npos; at = text.find(between, begin)) {
    parts.push_back(text.substr(begin, at - begin));
    begin = at + between.size();
  }
  parts.push_back(text.substr(begin));
  return parts;
}

/// "a b", of words, without those that are empty.
texts words(const std::string& text) {
  texts all = split(text, " ");
  std::erase(all, "");
  return all;
}

/// With \n, \0, \xHH and \\ for what they stand for.
std::string unescaped(const std::string& text) {
  std::string plain;
  for (std::size_t at = 0; at < text.size(); ++at) {
    if (text[at] != '\\' || at + 1 == text.size()) {
      plain += text[at];
      continue;
    }
    const char letter = text[++at];
    if (letter == 'x') {
      plain += static_cast<char>(std::stoi(text.substr(at + 1, 2), nullptr, 16));
      at += 2;
    } else {
      plain += letter == 'n' ? '\n' : letter == 'r' ? '\r' : letter == '0' ? '\0' : letter;
    }
  }
  return plain;
}

/// Bytes of the files of a folder, and kinds of what else there is.
std::map<std::string, std::string> all_in(const scratch& folder) {
  std::map<std::string, std::string> found;
  for (const auto& entry : fs::recursive_directory_iterator(folder.path())) {
    const auto type = entry.symlink_status().type();
    found[entry.path().string()] =
        type == fs::file_type::regular ? contents(entry.path()) : std::to_string(static_cast<int>(type));
  }
  return found;
}

std::string kind(const json& value) {
  if (value.is_null()) return "~null";
  if (value.is_string()) return "~text";
  if (value.is_boolean()) return "~flag";
  if (value.is_number_integer()) return "~integer";
  if (value.is_number()) return "~number";
  return value.is_array() ? "~list" : "~object";
}

bool is_kind(const json& value) { return value.is_string() && value.get<std::string>().starts_with("~"); }

/// Differences of a document from its golden one; names of members and their order count.
void compare(const json& golden, const json& found, double tolerance, const std::string& at, texts& wrong) {
  if (is_kind(golden)) {
    if (golden != kind(found)) wrong.push_back(at + " is " + kind(found) + ", not " + golden.dump());
  } else if (kind(golden) != kind(found) || golden.size() != found.size()) {
    wrong.push_back(at + " is " + found.dump().substr(0, 80) + ", not " + golden.dump().substr(0, 80));
  } else if (golden.is_object()) {
    for (auto a = golden.begin(), b = found.begin(); a != golden.end(); ++a, ++b) {
      if (a.key() != b.key()) wrong.push_back(at + " has " + b.key() + " where " + a.key() + " was");
      compare(a.value(), b.value(), tolerance, at + "/" + a.key(), wrong);
    }
  } else if (golden.is_array()) {
    for (std::size_t k = 0; k < golden.size(); ++k)
      compare(golden[k], found[k], tolerance, at + "/" + std::to_string(k), wrong);
  } else if (golden.is_number_float()) {
    const double a = golden;
    const double b = found;
    if (!(std::abs(a - b) <= tolerance * std::max(std::abs(a), std::abs(b))))
      wrong.push_back(at + " is " + found.dump() + ", not " + golden.dump());
  } else if (golden != found) {
    wrong.push_back(at + " is " + found.dump() + ", not " + golden.dump());
  }
}

/// What of a document its JSON Schema refuses: by the words that the program's schemas have.
void find_violations(const json& schema, const json& value, const std::string& at, texts& wrong) {
  if (schema.contains("const") && schema["const"] != value)
    wrong.push_back(at + " must be " + schema["const"].dump());
  if (schema.contains("type")) {
    const auto is = [&](const json& type) {
      return type == "object"    ? value.is_object()
             : type == "array"   ? value.is_array()
             : type == "string"  ? value.is_string()
             : type == "boolean" ? value.is_boolean()
             : type == "integer" ? value.is_number_integer()
             : type == "number"  ? value.is_number()
                                 : type == "null" && value.is_null();
    };
    if (std::none_of(schema["type"].begin(), schema["type"].end(), is))
      return wrong.push_back(at + " must be " + schema["type"].dump());
  }
  if (value.is_array() && schema.contains("items")) {
    for (std::size_t k = 0; k < value.size(); ++k)
      find_violations(schema["items"], value[k], at + "/" + std::to_string(k), wrong);
  }
  if (!value.is_object()) return;
  for (const auto& name : schema.value("required", json::array())) {
    if (!value.contains(name)) wrong.push_back(at + " lacks " + name.get<std::string>());
  }
  const json others = schema.value("additionalProperties", json(true));
  for (const auto& [name, one] : value.items()) {
    const json of_name = schema.value("properties", json::object()).value(name, others);
    if (of_name == false) wrong.push_back(at + " must not have " + name);
    if (of_name.is_object()) find_violations(of_name, one, at + "/" + name, wrong);
  }
}

/// What a golden file has of a document: kinds of what is measured anew, and where it had them before.
void keep_kinds(json& found, const json& before) {
  if (!found.is_structured()) return;
  for (auto one = found.begin(); one != found.end(); ++one) {
    json was;
    if (found.is_object() && before.is_object()) was = before.value(one.key(), json());
    if (found.is_array() && before.is_array() && !before.empty())
      was = before[std::min(static_cast<std::size_t>(one - found.begin()), before.size() - 1)];
    const bool is_time = found.is_object() && is_measured_anew(one.key());
    if (is_time || is_kind(was)) {
      *one = kind(*one);
    } else {
      keep_kinds(*one, was);
    }
  }
}

/// With what has no objects or lists in it on one line.
std::string printed(const json& value, const std::string& indent = "\n ") {
  const auto is_plain = [](const json& one) { return !one.is_structured() || one.empty(); };
  if (is_plain(value) || (std::all_of(value.begin(), value.end(), is_plain) && value.dump().size() < 110))
    return value.dump();
  std::string text = value.is_array() ? "[" : "{";
  for (auto one = value.begin(); one != value.end(); ++one) {
    if (one != value.begin()) text += ",";
    text += indent;
    if (value.is_object()) text += json(one.key()).dump() + ": ";
    text += printed(*one, indent + " ");
  }
  return text + indent.substr(0, indent.size() - 1) + (value.is_array() ? "]" : "}");
}

struct answer {
  finished done;
  json document;
};

/// The state of a table while its rows are run.
class table {
 public:
  explicit table(std::string name) : name_(std::move(name)) { new_folder(); }

  void take(const std::string& line, int number) {
    number_ = number;
    std::string rest = with_lets(line);
    if (takes(rest, "let ")) {
      const auto at = rest.find(" = ");
      lets_[rest.substr(0, at)] = rest.substr(at + 3);
    } else if (takes(rest, "== ")) {
      new_folder();
    } else if (rest == "@" || takes(rest, "@ ")) {
      prefix_ = rest == "@" ? "" : rest + " ";
    } else if (takes(rest, "file ")) {
      const auto at = rest.find(" = ");
      write(rest.substr(0, at), unescaped(rest.substr(at + 3)));
    } else if (takes(rest, "copy ")) {
      fs::copy_file(source + "inputs/" + rest, *folder_ / rest, fs::copy_options::overwrite_existing);
    } else if (takes(rest, "sh ")) {
      const auto done = shell(*folder_, rest);
      if (done.code != 0) tell("sh " + rest, {"ended with " + std::to_string(done.code)}, done.err);
    } else if (takes(rest, "target ")) {
      const auto at = rest.find(" of ");
      target_ = rest.substr(0, at);
      forge_of_ = at == std::string::npos ? "" : rest.substr(at + 4);
    } else {
      row(rest);
    }
  }

  texts wrong;
  int rows = 0;

 private:
  void new_folder() {
    folder_.reset();
    folder_ = std::make_unique<scratch>("table_" + name_);
    prefix_ = "";
  }

  void write(const std::string& file, const std::string& text) {
    fs::create_directories((*folder_ / file).parent_path());
    std::ofstream(*folder_ / file, std::ios::binary) << text;
  }

  std::string with_lets(std::string line) const {
    for (bool again = true; again;) {
      again = false;
      for (const auto& [name, text] : lets_) {
        const auto at = line.find("{" + name + "}");
        if (at == std::string::npos) continue;
        line.replace(at, name.size() + 2, text);
        again = true;
      }
    }
    return line;
  }

  /// {a;b} is a in one line and b in the next.
  static texts expanded(const std::string& line) {
    const auto begin = line.rfind('{');
    const auto end = line.find('}', begin);
    if (begin == std::string::npos || end == std::string::npos || !has(line.substr(begin, end - begin), ";"))
      return {line};
    texts all;
    for (const auto& one : split(line.substr(begin + 1, end - begin - 1), ";")) {
      for (auto& whole : expanded(line.substr(0, begin) + one + line.substr(end + 1))) all.push_back(whole);
    }
    return all;
  }

  void row(std::string line) {
    must_be_found_ = takes(line, "x");
    auto parts = split(line, " | ");
    const auto space = parts[0].find(' ');
    const int code = std::stoi(parts[0]);
    std::string arguments = space == std::string::npos ? "" : parts[0].substr(space + 1);
    if (!takes(arguments, "$ ")) arguments = "\"$nysalt\" " + prefix_ + arguments;
    parts.erase(parts.begin());
    for (const auto& one : expanded(arguments)) {
      ++rows;
      texts problems;
      std::string said;
      try {
        tried(one, code, parts, problems, said);
      } catch (const std::exception& error) {
        problems.push_back(error.what());
      }
      if (!must_be_found_) {
        if (!problems.empty()) tell(one, problems, said);
      } else if (problems.empty()) {
        tell(one, {"this row must be found wrong"}, said);
      }
    }
  }

  void tell(const std::string& line, const texts& problems, const std::string& said) {
    std::string all = name_ + ".txt:" + std::to_string(number_) + ": " + line.substr(0, 300);
    for (const auto& one : problems) all += "\n    " + one;
    wrong.push_back(all + "\n    said: " + said.substr(0, 500));
  }

  /// Runs one command.
  void tried(const std::string& line, int code, const texts& checks, texts& problems, std::string& said) {
    for (auto check : checks) {
      if (check == "text:" || takes(check, "text: "))
        write(target_, check == "text:" ? "" : unescaped(check));
      if (takes(check, "with: ")) write(target_, forged(contents(*folder_ / forge_of_), change(check)));
    }
    const auto before = all_in(*folder_);
    const finished done = shell(*folder_, line, 120);
    said = done.err;
    const auto must = [&](bool is_so, const std::string& what) {
      if (!is_so) problems.push_back(what);
    };
    must(done.code == code, "ended with " + std::to_string(done.code));
    for (const char* of_a_library : {"filesystem error", "json.exception"})
      must(!has(done.err, of_a_library), of_a_library);
    if (code == 2) {
      must(done.out.empty(), "printed " + done.out.substr(0, 80));
      must(std::count_if(done.err.begin(), done.err.end(), [](unsigned char c) { return c < ' '; }) == 1 &&
               done.err.ends_with('\n') && done.err.starts_with("nysalt: "),
           "must be one line of nysalt");
      must(all_in(*folder_) == before, "the folder changed");
    }
    answer now{done, json_of(done)};
    bool may_speak = code != 0;
    for (auto check : checks) may_speak = holds(check, now, problems) || may_speak;
    must(may_speak || done.err.empty(), "must say nothing on the standard error");
  }

  /// Whether something on the standard error was asked for.
  bool holds(std::string check, const answer& now, texts& problems) {
    const auto must = [&problems, whole = check](bool is_so) {
      if (!is_so) problems.push_back("not so: " + whole);
    };
    const auto plain = [&](const answer& one) { return without_times(one.done.out); };
    if (check == "any err") return true;
    if (check.starts_with("text:") || check.starts_with("with: ")) return false;
    if (takes(check, "label: ")) {
      labels_[check] = now;
    } else if (takes(check, "same: ")) {
      must(!now.done.out.empty() && plain(now) == plain(labels_.at(check)));
    } else if (takes(check, "other: ")) {
      must(plain(now) != plain(labels_.at(check)));
    } else if (takes(check, "out: ")) {
      must(has(now.done.out, unescaped(check)));
    } else if (takes(check, "first: ")) {
      must(now.done.out.starts_with(unescaped(check)));
    } else if (takes(check, "width: ")) {
      for (const std::string& line : split(now.done.out, "\n")) {
        const auto begins = [](char c) { return (static_cast<unsigned char>(c) & 0xc0U) != 0x80U; };
        must(std::count_if(line.begin(), line.end(), begins) <= std::stol(check));
      }
    } else if (takes(check, "not out: ")) {
      must(!has(now.done.out, unescaped(check)));
    } else if (takes(check, "not: ")) {
      must(!has(now.done.err, unescaped(check)));
    } else if (check == "files:" || takes(check, "files: ")) {
      const auto names = check == "files:" ? texts() : words(check);
      must(folder_->files() == std::set<std::string>(names.begin(), names.end()));
    } else if (takes(check, "holds ")) {
      const auto at = check.find(": ");
      must(has(contents(*folder_ / check.substr(0, at)), unescaped(check.substr(at + 2))));
    } else if (takes(check, "golden: ")) {
      const auto words_of = words(check);
      golden(words_of[0], std::stod(words_of[1]), now.document, problems);
    } else if (takes(check, "schema: ")) {
      const std::string file = NYSALT_SOURCE_DIR "/share/schemas/" + check + ".json";
      find_violations(json::parse(contents(file)), now.document, "", problems);
    } else if (takes(check, "json: ")) {
      must(is_so(check, now.document));
    } else {
      must(has(now.done.err, unescaped(check)));
      return true;
    }
    return false;
  }

  void golden(const std::string& name, double tolerance, json found, texts& problems) const {
    const fs::path file = source + "golden/" + name + ".json";
    const json before = json::parse(contents(file), nullptr, false);
    if (std::getenv("NYSALT_RECORD") != nullptr && !must_be_found_) {
      keep_kinds(found, before);
      std::ofstream(file) << printed(found) << '\n';
    } else {
      compare(before, found, tolerance, "", problems);
    }
  }

  static std::function<void(json&)> change(const std::string& how) {
    const auto at = how.find(" = ");
    const json::json_pointer place(how.substr(0, at));
    if (at == std::string::npos) {
      return [place](json& document) { document.at(place.parent_pointer()).erase(place.back()); };
    }
    return [place, value = json::parse(how.substr(at + 3))](json& document) { document[place] = value; };
  }

  /// All that a place of a document leads to; `*` leads to several.
  static std::vector<json> found(const json& document, const std::string& place) {
    std::vector<json> all{document};
    for (auto& step : split(place.substr(1), "/")) {
      const bool is_size = step.ends_with('#');
      if (is_size) step.pop_back();
      const auto bracket = step.find('[');
      const std::string selected = bracket == std::string::npos ? "" : step.substr(bracket + 1);
      const std::string member = step.substr(0, bracket);
      std::vector<json> next;
      for (const auto& one : all) {
        std::vector<json> below;
        if (member == "*") {
          below.assign(one.begin(), one.end());
        } else {
          below.push_back(one.is_array() ? one.at(static_cast<std::size_t>(std::stoul(member)))
                                         : one.at(member));
        }
        for (const auto& value : below) {
          if (selected.empty()) {
            next.push_back(is_size ? json(value.size()) : value);
            continue;
          }
          const auto at = selected.find('=');
          const std::string wanted = selected.substr(at + 1, selected.size() - at - 2);
          for (const auto& row : value) {
            const json& member_of_row = row.at(selected.substr(0, at));
            if (member_of_row == wanted || member_of_row.dump() == wanted) next.push_back(row);
          }
        }
      }
      all = next;
    }
    if (all.empty()) throw std::runtime_error("nothing is at " + place);
    return all;
  }

  json value(std::string text, const json& document) const {
    const auto star = text.find("*");
    if (star != std::string::npos && text.find_first_not_of("0123456789.e-") == star)
      return std::stod(text) * value(text.substr(star + 1), document).get<double>();
    if (text.starts_with("/")) {
      const auto all = found(document, text);
      return has(text, "*") ? json(all) : all[0];
    }
    const auto colon = text.find(":/");
    if (colon != std::string::npos && !text.starts_with("\""))
      return found(labels_.at(text.substr(0, colon)).document, text.substr(colon + 1))[0];
    return json::parse(text);
  }

  bool is_so(const std::string& check, const json& document) const {
    const auto first = check.find(' ');
    const auto second = check.find(' ', first + 1);
    const std::string place = check.substr(0, first);
    const std::string how = check.substr(first + 1, second - first - 1);
    const std::string rest = check.substr(second + 1);
    if (how == "set") {
      std::set<std::string> all;
      for (const auto& one : found(document, place)) all.insert(one.get<std::string>());
      const auto wanted = words(rest);
      return all == std::set<std::string>(wanted.begin(), wanted.end());
    }
    const json left = value(place, document);
    if (how == "has" || how == "lacks") {
      const bool is_in = has(left.is_string() ? left.get<std::string>() : left.dump(), unescaped(rest));
      return is_in == (how == "has");
    }
    if (how == "~") {
      const auto words_of = words(rest);
      const double right = value(words_of.at(0), document);
      return std::abs(left.get<double>() - right) <= std::stod(words_of.at(1)) * std::abs(right);
    }
    const json right = value(rest, document);
    if (how == "=") return left == right;
    if (how == "!=") return left != right;
    if (!left.is_number() || !right.is_number()) return false;
    return how == "<"    ? left < right
           : how == ">"  ? left > right
           : how == "<=" ? left <= right
           : how == ">=" ? left >= right
                         : throw std::runtime_error("how is " + how);
  }

  std::string name_;
  int number_ = 0;
  bool must_be_found_ = false;
  std::unique_ptr<scratch> folder_;
  std::string prefix_;
  std::string target_;
  std::string forge_of_;
  std::map<std::string, std::string> lets_;
  std::map<std::string, answer> labels_;
};

/// All lines of a table with their numbers; what continues a line is part of it.
texts wrong_rows(const std::string& text, const std::string& name, int& rows) {
  std::vector<std::pair<int, std::string>> lines;
  int number = 0;
  for (const auto& line : split(text, "\n")) {
    ++number;
    if (line.starts_with("  |")) {
      lines.back().second += line.substr(1);
    } else if (!line.empty() && !line.starts_with("#")) {
      lines.emplace_back(number, line);
    }
  }
  table all(name);
  for (const auto& [at, line] : lines) all.take(line, at);
  rows = all.rows;
  return all.wrong;
}

}  // namespace

texts wrong_rows(const std::string& text, const std::string& name) {
  int rows = 0;
  return wrong_rows(text, name, rows);
}

void run_tables_named() {
  const auto& suite = boost::unit_test::framework::master_test_suite();
  BOOST_REQUIRE(suite.argc > 1);
  for (int k = 1; k < suite.argc; ++k) {
    const fs::path file = suite.argv[k];
    const std::string text = contents(file);
    int rows = 0;
    for (const auto& wrong : wrong_rows(text, file.stem().string(), rows)) BOOST_TEST(false, wrong);
    BOOST_TEST(rows > 0);
    BOOST_TEST(text.find("\nx") != std::string::npos, file << " has no row that must be found wrong");
  }
}

}  // namespace nysalt::test
