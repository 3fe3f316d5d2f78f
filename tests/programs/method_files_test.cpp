// SPDX-License-Identifier: BSL-1.0
// Methods on disk: what was learned is used as it was learned, and what is not whole, not ours or not true is
// refused.
#include <boost/test/unit_test.hpp>

#include <functional>
#include <string_view>
#include <vector>

#include "../support/forged.hpp"
#include "../support/program.hpp"

using namespace nysalt::test;
using json = nlohmann::ordered_json;

namespace {

const std::string learn =
    "learn --family nystrom --trajectories 20 --horizon 0.2 --fine-step 0.001 --step 0.02 --output ";
const std::string errors = "compare --trajectories 3 --horizon 0.2 --fine-step 0.001 --json --methods ";
const std::string samples = " --horizon 0.2 --observables energy,q1 ";

void write(const scratch& folder, const std::string& name, const std::string& text) {
  std::ofstream(folder / name, std::ios::binary) << text;
}

bool refused(const finished& done, const std::vector<std::string>& words) {
  bool all = done.code == 2 && done.out.empty() && done.err.starts_with("nysalt: ") &&
             done.err.find('\n') == done.err.size() - 1;
  for (const auto& word : words) all = all && done.err.find(word) != std::string::npos;
  return all;
}

/// Every reader of a method file must refuse this one.
void all_refuse(const scratch& folder, const std::string& name, const std::vector<std::string>& words) {
  for (const auto& arguments : {"run --step 0.02 --horizon 0.2 --method " + name,
                                errors + "verlet," + name + " --steps 0.02", "stability --method " + name}) {
    const finished done = run(folder, arguments);
    BOOST_TEST_CONTEXT(arguments << "\ncode " << done.code << "\nsaid: " << done.err) {
      BOOST_TEST(refused(done, words));
    }
  }
}

/// One folder with one scheme, learned once.
struct learned {
  scratch folder{"scheme"};
  std::string text;
  learned() {
    const finished done = run(folder, learn + "scheme.json");
    BOOST_REQUIRE_MESSAGE(done.code == 0, done.err);
    text = contents(folder / "scheme.json");
  }
};

std::string table(const std::string& letters, const std::vector<double>& coefficients, json more = {}) {
  json document{
      {"format", "nysalt table"}, {"version", 1}, {"letters", letters}, {"coefficients", coefficients}};
  if (more.is_object()) document.update(more);
  return document.dump();
}

/// Those of a method that the program knows by name, as it prints them.
std::vector<double> coefficients_of(const std::string& method) {
  return json_of(run("stability --json --method " + method))["coefficients"];
}

}  // namespace

BOOST_FIXTURE_TEST_CASE(a_scheme_is_used_as_it_was_learned, learned) {
  const json scheme = json::parse(text);
  BOOST_TEST(scheme["format"] == "nysalt scheme");
  const finished rows = run(folder, "run --method scheme.json --step 0.02 --json" + samples);
  BOOST_TEST(rows.code == 0);
  BOOST_TEST(json_of(rows)["warnings"].empty());

  // Numbers survive the file to the last bit: its windows are those of the parameters that were printed.
  const auto parameters = scheme["parameters"];
  const auto of_file = json_of(run(folder, "stability --method scheme.json --json"));
  const auto of_family = json_of(run(folder, "stability --json --family nystrom --parameters " +
                                                 parameters["b1"].dump() + "," + parameters["beta1"].dump()));
  BOOST_TEST(of_file["coefficients"] == of_family["coefficients"]);
  BOOST_TEST(of_file["windows"] == of_family["windows"]);
  BOOST_TEST(of_file["limit"].get<double>() > 0.0);

  // Beside learning in place, with the same options: the same errors.
  const auto compared =
      json_of(run(folder, errors + "scheme.json,learned:nystrom --steps 0.01,0.02 --learn-trajectories 20 "
                                   "--learn-horizon 0.2 --learn-loss trajectory"));
  std::vector<double> errors_at_step;
  int rows_of_file = 0;
  for (const auto& row : compared["rows"]) {
    if (row["method"] == "scheme.json") ++rows_of_file;
    if (row["step"] == 0.02) errors_at_step.push_back(row["error"]);
  }
  BOOST_TEST(rows_of_file == 1);  // the scheme at its own step only
  BOOST_REQUIRE(errors_at_step.size() == 2U);
  BOOST_TEST(errors_at_step[0] == errors_at_step[1]);
}

BOOST_FIXTURE_TEST_CASE(a_scheme_stays_at_its_step_and_system, learned) {
  struct elsewhere {
    std::string where;
    std::vector<std::string> words;
  };
  for (const auto& [where, words] :
       {elsewhere{"--step 0.01", {"step 0.02", "0.01", "--force"}},
        elsewhere{"--step 0.020001", {"step 0.02", "0.020001", "--force"}},
        elsewhere{"--step 0.02 --omega 51", {"omega=50", "omega=51", "--force"}},
        elsewhere{"--step 0.02 --pairs 4 --omega 51", {"pairs=3", "pairs=4", "--force"}},
        elsewhere{"--step 0.02 --system pendulum", {"fpu_chain", "pendulum", "--force"}}}) {
    const std::string arguments = "run --method scheme.json --json --horizon 0.2 " + where;
    const finished without = run(folder, arguments);
    BOOST_TEST_CONTEXT(where << " " << without.err) { BOOST_TEST(refused(without, words)); }
    const finished with = run(folder, arguments + " --force");
    BOOST_TEST_CONTEXT(where << " " << with.err) {
      BOOST_TEST(with.code == 0);
      BOOST_TEST(with.err == "");  // with --json the warning is in the document
      const std::string warnings = json_of(with)["warnings"].dump();
      for (const auto& word : words) BOOST_TEST(warnings.find(word) != std::string::npos, word);
    }
  }
  const finished spoken = run(folder, "run --method scheme.json --horizon 0.2 --step 0.01 --force");
  BOOST_TEST(spoken.err.starts_with("nysalt: warning: scheme.json must run at the step 0.02, "));
  // One step of a list must be its own.
  BOOST_TEST(
      refused(run(folder, errors + "verlet,scheme.json --steps 0.01"), {"0.02", "--steps", "--force"}));
  BOOST_TEST(
      refused(run(folder, errors + "verlet,scheme.json --steps 0.02 --equal-cost"), {"0.02", "--steps"}));
  BOOST_TEST(refused(run(folder, errors + "verlet,scheme.json --steps 0.02 --omega 51"), {"omega=50"}));
  const finished forced = run(folder, errors + "scheme.json --steps 0.01 --force");
  BOOST_TEST(forced.code == 0);
  BOOST_TEST(json_of(forced)["warnings"].dump().find("0.02") != std::string::npos);
  // A step that rounding made is its step.
  BOOST_TEST(run(folder, "run --method scheme.json --horizon 0.2 --step 0.020000000000000004").code == 0);
}

BOOST_FIXTURE_TEST_CASE(a_scheme_that_is_cut_off_is_refused, learned) {
  const std::size_t end = text.find_last_of('}');
  for (const std::size_t length : {end, end - 1, text.size() / 2, text.size() / 3, std::size_t{1}}) {
    write(folder, "cut.json", text.substr(0, length));
    const finished done = run(folder, "run --method cut.json --step 0.02 --horizon 0.2");
    BOOST_TEST_CONTEXT(length << " bytes: " << done.err) {
      BOOST_TEST(refused(done, {"cut.json", "must be whole JSON"}));
    }
  }
  write(folder, "cut.json", "");
  all_refuse(folder, "cut.json", {"cut.json", "must be whole JSON"});
  write(folder, "more.json", text + text);
  all_refuse(folder, "more.json", {"more.json", "must be whole JSON"});
}

// Any digit, and any word.
BOOST_FIXTURE_TEST_CASE(a_scheme_that_was_edited_is_refused, learned) {
  const auto edited = [&](const std::string& key, char from, char to) {
    std::string other = text;
    const std::size_t at = other.find(from, other.find('"' + key + '"') + key.size() + 2);
    BOOST_REQUIRE(at != std::string::npos);
    other[at] = to;
    return other;
  };
  const std::string b1 = json::parse(text)["parameters"]["b1"].dump();
  std::string digit = text;
  char& last = digit[digit.find(b1) + b1.size() - 2];
  last = last == '5' ? '6' : '5';
  for (const auto& other :
       {digit, edited("step", '2', '3'), edited("omega", '5', '6'), edited("usable", 't', 'T'),
        edited("seed", '1', '2'), edited("checksum", ':', ';'), edited("nysalt", '1', '2')}) {
    write(folder, "edited.json", other);
    const finished done = run(folder, "run --method edited.json --step 0.02 --horizon 0.2");
    const bool is_json = json::accept(other);
    BOOST_TEST_CONTEXT(done.err) {
      BOOST_TEST(refused(done, {"edited.json", is_json ? "checksum" : "whole"}));
    }
    BOOST_TEST(run(folder, "run --method edited.json --step 0.02 --horizon 0.2 --force").code == 2);
  }
  // Spaces are no edit.
  write(folder, "spaced.json", json::parse(text).dump(7));
  BOOST_TEST(run(folder, "run --method spaced.json --step 0.02 --horizon 0.2").code == 0);
}

BOOST_FIXTURE_TEST_CASE(a_scheme_of_another_kind_is_refused, learned) {
  struct change {
    std::function<void(json&)> of;
    std::vector<std::string> words;
  };
  const std::vector<change> changes{
      {[](json& s) { s["version"] = 4; }, {"\"version\"", "got 4", "newer"}},
      {[](json& s) { s["version"] = 3; }, {"without several steps", "got 3"}},
      {[](json& s) { s["version"] = 0; }, {"\"version\"", "got 0"}},
      {[](json& s) { s["version"] = "1"; }, {"\"version\"", "number"}},
      {[](json& s) { s.erase("version"); }, {"must have the member \"version\""}},
      {[](json& s) { s["format"] = "another"; }, {"\"format\"", "nysalt scheme"}},
      {[](json& s) { s["format"] = 7; }, {"\"format\""}},
      {[](json& s) { s.erase("format"); }, {"\"format\""}},
      {[](json& s) { s["family"] = "nosuch"; }, {"family 'nosuch'", "nysalt list"}},
      {[](json& s) { s["family"] = nullptr; }, {"\"family\"", "text"}},
      {[](json& s) { s["parameters"].erase("b1"); }, {"must have the member \"b1\""}},
      {[](json& s) { s["parameters"]["c9"] = 1.0; }, {"b1, beta1"}},
      {[](json& s) { s["parameters"]["b1"] = "0.5"; }, {"\"b1\"", "number"}},
      {[](json& s) { s["parameters"]["b1"] = nullptr; }, {"\"b1\"", "number"}},
      {[](json& s) { s["parameters"]["b1"] = 1.5; }, {"b1", "(0, 1)"}},
      {[](json& s) {
         s["parameters"] = {0.5, 0.4};
       },
       {"\"parameters\"", "object"}},
      {[](json& s) { s.erase("parameters"); }, {"must have the member \"parameters\""}},
      {[](json& s) { s["step"] = -0.02; }, {"\"step\"", "positive"}},
      {[](json& s) { s["step"] = 0; }, {"\"step\"", "positive"}},
      {[](json& s) { s["step"] = true; }, {"\"step\"", "number"}},
      {[](json& s) { s["system"] = "fpu"; }, {"must have the member \"description\""}},
      {[](json& s) { s["system"].erase("description"); }, {"must have the member \"description\""}},
      {[](json& s) { s["usable"] = 1; }, {"\"usable\"", "true or false"}},
      {[](json& s) { s["reason"] = json::array(); }, {"\"reason\"", "text"}},
  };
  for (const auto& forgery : changes) {
    write(folder, "other.json", forged(text, forgery.of));
    const finished done = run(folder, "run --method other.json --step 0.02 --horizon 0.2");
    BOOST_TEST_CONTEXT(done.code << " " << done.err) {
      BOOST_TEST(refused(done, {"other.json"}));
      BOOST_TEST(refused(done, forgery.words));
    }
  }
  // That the changes are refused for what they are, and not for the forgery: no change is none.
  write(folder, "same.json", forged(text, [](json&) {}));
  BOOST_TEST(contents(folder / "same.json") + "\n" == text);
}

// Members of a JSON object have no order.
BOOST_FIXTURE_TEST_CASE(parameters_are_read_by_name, learned) {
  write(folder, "turned.json", forged(text, [](json& s) {
          const json was = s["parameters"];
          s["parameters"] = {{"beta1", was["beta1"]}, {"b1", was["b1"]}};
        }));
  BOOST_TEST(run(folder, "run --method turned.json --step 0.02" + samples).out ==
             run(folder, "run --method scheme.json --step 0.02" + samples).out);
}

// With the step itself as fine step the reference errs as much as what is learned.
BOOST_AUTO_TEST_CASE(a_fit_that_is_not_usable_says_so_wherever_it_goes) {
  const scratch folder("not_usable");
  const std::string poor =
      "learn --family nystrom --trajectories 3 --step 0.1 --fine-step 0.1 --output poor.json";
  const finished withheld = run(folder, poor);
  BOOST_TEST(withheld.code == 3);
  BOOST_TEST(withheld.err.find("not written") != std::string::npos);
  BOOST_TEST(folder.files().empty());
  BOOST_TEST(run(folder, poor + " --force").code == 3);
  const std::string use = "run --method poor.json --step 0.1 --horizon 0.2 --json";
  BOOST_TEST(refused(run(folder, use), {"poor.json", "not usable", "--force"}));
  const finished forced = run(folder, use + " --force");
  BOOST_TEST(json_of(forced)["warnings"].dump().find("not usable") != std::string::npos);
}

BOOST_AUTO_TEST_CASE(what_is_no_method_at_all_is_refused) {
  const scratch folder("foreign");
  std::filesystem::create_directory(folder / "folder.json");
  all_refuse(folder, "missing.json", {"missing.json", "cannot read"});
  all_refuse(folder, "folder.json", {"folder.json", "cannot read"});
  all_refuse(folder, "nowhere/scheme", {"nowhere/scheme", "cannot read"});
  struct file {
    std::string text;
    std::string word;
  };
  for (const auto& [text, word] : {file{"{}", "\"format\""},
                                   {"[]", "\"format\""},
                                   {"null", "\"format\""},
                                   {"3", "\"format\""},
                                   {"\"nysalt scheme\"", "\"format\""},
                                   {R"({"name": "another program", "version": 3})", "\"format\""},
                                   {"not json", "whole"},
                                   {"{\"format\": \"nysalt table\",}", "whole"},
                                   {std::string(100'000, '['), "nested"},
                                   {std::string("\0\0\0\x1b[31m", 8), "whole"},
                                   {"\xff\xfe{}", "whole"},
                                   {R"({"format": "\u001b[31m\nnysalt"})", "\"format\""}}) {
    write(folder, "file.json", text);
    const finished done = run(folder, "run --method file.json --step 0.02 --horizon 0.2");
    BOOST_TEST_CONTEXT(text.substr(0, 50) << " " << done.err) {
      BOOST_TEST(refused(done, {"file.json", word}));
    }
  }
}

BOOST_AUTO_TEST_CASE(a_table_is_the_method_that_it_writes_down) {
  const scratch folder("table");
  write(folder, "mine.json", table("ABA", {0.5, 1.0, 0.5}, {{"name", "mine"}, {"order", 2}}));
  write(folder, "bare", table("BAB", {0.5, 1.0, 0.5}));
  const std::string rest = " --step 0.02 --trajectories 2" + samples;
  const finished from_table = run(folder, "run --method mine.json" + rest);
  BOOST_TEST(from_table.code == 0);
  BOOST_TEST(from_table.out == run(folder, "run --method verlet_aba" + rest).out);
  BOOST_TEST(from_table.out != run(folder, "run --method verlet" + rest).out);
  BOOST_TEST(run(folder, "run --method ./bare" + rest).out == run(folder, "run --method verlet" + rest).out);

  const auto rows = json_of(run(folder, errors + "verlet_aba,mine.json --steps 0.01,0.02"))["rows"];
  BOOST_REQUIRE(rows.size() == 4U);
  for (std::size_t i = 0; i < 4; i += 2) {
    BOOST_TEST(rows[i]["error"] == rows[i + 1]["error"]);
    BOOST_TEST(rows[i]["evaluations_per_time"] == rows[i + 1]["evaluations_per_time"]);
  }
  const auto stability = json_of(run(folder, "stability --method mine.json --json"));
  BOOST_TEST(stability["order"] == 2);
  BOOST_TEST(std::abs(stability["limit"].get<double>() - 2.0) < 1e-9);  // Verlet's, known exactly
}

BOOST_AUTO_TEST_CASE(the_order_of_a_table_is_found_from_its_coefficients) {
  const scratch folder("order");
  const auto order = [&](const std::string& text) {
    write(folder, "table.json", text);
    const finished done = run(folder, "stability --method table.json --json");
    BOOST_REQUIRE_MESSAGE(done.code == 0, done.err);
    return json_of(done)["order"].get<int>();
  };
  BOOST_TEST(order(table("AB", {1.0, 1.0})) == 1);
  BOOST_TEST(order(table("BAB", {0.5, 1.0, 0.5})) == 2);
  const auto srkn6b = coefficients_of("srkn6b");
  BOOST_TEST(order(table("BABABABABABAB", srkn6b)) == 4);
  BOOST_TEST(order(table("BABABABABABAB", srkn6b, {{"order", 4}})) == 4);
  BOOST_TEST(order(table("BABABABABABAB", srkn6b, {{"order", 3}})) == 4);  // less was promised than is kept
}

BOOST_AUTO_TEST_CASE(a_table_that_is_not_true_is_refused) {
  auto mistyped = coefficients_of("srkn6b");  // in four places, so that the sums still fit
  mistyped[1] += 0.0009;
  mistyped[5] -= 0.0009;
  mistyped[7] -= 0.0009;
  mistyped[11] += 0.0009;
  const scratch folder("bad_table");
  struct file {
    std::string text;
    std::vector<std::string> words;
  };
  const json good = json::parse(table("ABA", {0.5, 1.0, 0.5}));
  const auto but = [&](const char* key, const json& value) {
    json document = good;
    document[key] = value;
    return document.dump();
  };
  for (const auto& [text, words] : std::vector<file>{
           {table("ABA", {0.5, 1.0, 0.4}), {"A adds up to 0.9"}},
           {table("ABA", {0.5, 1.01, 0.5}), {"B adds up to 1.01"}},
           {table("A", {1.0}), {"B adds up to 0"}},
           {table("ABA", {0.5, 1.0, 0.5}, {{"order", 4}}), {"\"order\" must be at most 2", "got 4"}},
           {table("AB", {1.0, 1.0}, {{"order", 2}}), {"\"order\" must be at most 1", "got 2"}},
           {table("BABABABABABAB", mistyped, {{"order", 4}}), {"\"order\"", "got 4", "mistyped"}},
           {table("AXA", {0.5, 1.0, 0.5}), {"letter X", "A, B"}},
           {table("aba", {0.5, 1.0, 0.5}), {"letter a", "A, B"}},
           {table("", {}), {"letter"}},
           {table("ABA", {0.5, 1.0}), {"2 coefficients", "3 letters"}},
           {table("ABA", {0.5, 1.0, 0.25, 0.25}), {"4 coefficients", "3 letters"}},
           {table("ABABA", {1e308, 0.5, -1e308, 0.5, 1.0}), {"consistent", "moderate"}},
           {table(std::string(40'000, 'A'), std::vector<double>(40'000, 2.5e-5)),
            {"at most 200 letters", "40000"}},
           {but("coefficients", {0.5, nullptr, 0.5}), {"\"coefficients\"", "finite numbers"}},
           {but("coefficients", {0.5, "1", 0.5}), {"\"coefficients\"", "finite numbers"}},
           {but("coefficients", 1.0), {"\"coefficients\"", "list"}},
           {but("coefficients", {{"a", 0.5}}), {"\"coefficients\"", "list"}},
           {but("letters", 3), {"\"letters\"", "text"}},
           {but("name", 3), {"\"name\"", "text"}},
           {but("order", "two"), {"\"order\"", "number"}},
           {but("version", 2), {"\"version\"", "got 2", "newer"}},
           {R"({"format": "nysalt table", "version": 1})", {"must have the member"}},
           {R"({"format": "nysalt table", "version": 1, "letters": "ABA"})",
            {"must have the member \"coefficients\""}},
           {R"({"format": "nysalt table", "version": 1, "letters": "AB", "coefficients": [1e999, 1]})",
            {"must be finite"}},
           {R"({"format": "nysalt table", "version": 1, "letters": "AB", "coefficients": [NaN, 1]})",
            {"whole"}}}) {
    write(folder, "table.json", text);
    const finished done = run(folder, "run --method table.json --step 0.02 --horizon 0.2");
    BOOST_TEST_CONTEXT(text << "\n" << done.code << " " << done.err) {
      BOOST_TEST(refused(done, {"table.json"}));
      BOOST_TEST(refused(done, words));
    }
  }
  // Without the promise of order 4 the mistyped table is a method, of a lower order.
  write(folder, "table.json", table("BABABABABABAB", mistyped));
  BOOST_TEST(json_of(run(folder, "stability --method table.json --json"))["order"] == 2);
}

// Its name goes to a terminal.
BOOST_AUTO_TEST_CASE(a_name_from_a_file_cannot_write_over_the_screen) {
  const scratch folder("name");
  write(folder, "table.json", table("ABA", {0.5, 1.0, 0.5}, {{"name", "a\n\x1b[31mb"}}));
  const finished done = run(folder, "run --method table.json --step 0.1 --horizon 0.1");
  BOOST_TEST(done.err.find("not linearly stable") != std::string::npos);
  for (std::size_t at = 0; at < done.err.size(); at = done.err.find('\n', at) + 1) {
    BOOST_TEST(done.err.substr(at).starts_with("nysalt: warning: "));
  }
  BOOST_TEST(done.err.find('\x1b') == std::string::npos);
}
