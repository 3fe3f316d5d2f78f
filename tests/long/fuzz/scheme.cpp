// SPDX-License-Identifier: BSL-1.0
// Scheme files: as they are, which their checksum refuses, and signed again.
#include <cstddef>
#include <cstdint>
#include <nlohmann/json.hpp>

#include "../../support/forged.hpp"
#include "method_files.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(reinterpret_cast<const char*>(data), size);
  nysalt::fuzz::try_method_file(text);
  const auto document = nlohmann::ordered_json::parse(text, nullptr, false);
  if (document.is_object()) nysalt::fuzz::try_method_file(nysalt::test::forged(text, [](auto&) {}));
  return 0;
}
