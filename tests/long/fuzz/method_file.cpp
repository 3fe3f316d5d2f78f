// SPDX-License-Identifier: BSL-1.0
// Method files, tables of coefficients and schemes: as they are (a checksum refuses changes), and signed
// again.
#include <cstddef>
#include <cstdint>
#include <nlohmann/json.hpp>

#include "../../support/forged.hpp"
#include "comparison/method_file.hpp"
#include "program_run.hpp"

using namespace nysalt::fuzz;

namespace {

/// The reader of all texts; commands, which take a hundred times as long, of some, and `compare` of few.
/// Asked for with --force, so that a file for another step or system goes further.
void try_method_file(const std::string& text) {
  const bool is_taken = takes([&] { nysalt::program::method_file_in(text, "method.json"); });
  if (!is_one_in(is_taken ? 16 : 256, text)) return;
  const input_file file{"method.json", text};
  const std::string step = "0.02";
  run({"stability", "--method", file.name, "--json"}, {file});
  run({"run", "--system", "fpu", "--method", file.name, "--step", step, "--horizon", "0.06", "--threads", "1",
       "--force", "--output", "out.csv"},
      {file});
  if (!is_one_in(1024, text)) return;
  run({"compare", "--system", "fpu", "--methods", "verlet," + file.name, "--steps", step, "--trajectories",
       "2", "--horizon", "0.06", "--fine-step", "0.01", "--threads", "1", "--force", "--json"},
      {file});
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(reinterpret_cast<const char*>(data), size);
  try_method_file(text);
  const auto document = nlohmann::ordered_json::parse(text, nullptr, false);
  if (document.is_object()) try_method_file(nysalt::test::forged(text, [](auto&) {}));
  return 0;
}
