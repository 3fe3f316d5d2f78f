// SPDX-License-Identifier: BSL-1.0
#include "force_library.hpp"

#include <dlfcn.h>

#include <atomic>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <memory>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

#include "comparison/refusal.hpp"
#include "nysalt/c_force.h"
#include "nysalt/core/fingerprint.hpp"
#include "nysalt/noises/counter_noise.hpp"

namespace nysalt::program {

namespace {

using column = vector<double, Eigen::Dynamic>;

/// The functions of a library; null where one that may be missing is.
struct c_functions {
  decltype(nysalt_force)* force;
  decltype(nysalt_potential)* potential;
  decltype(nysalt_start)* start;
  decltype(nysalt_open)* open;
  decltype(nysalt_close)* close;
  std::int64_t dimension;
  std::vector<double> inverse_masses;
  std::string description;
  std::string kind;  // the description if the library declares none
  std::string file;
};

/// What nysalt_open gave each thread that came; closed together at the end. Thread-safe. Cost: of a thread
/// that comes again with no other library between, a comparison.
class data_of_threads {
 public:
  explicit data_of_threads(const c_functions& of) : of_(of), number_(next_number()) { get(); }
  data_of_threads(const data_of_threads&) = delete;
  data_of_threads& operator=(const data_of_threads&) = delete;
  ~data_of_threads() {
    if (of_.close == nullptr) return;
    for (const auto& [thread, data] : opened_) of_.close(data);
  }

  void* get() const {
    if (of_.open == nullptr) return nullptr;
    thread_local std::pair<std::uint64_t, void*> last;  // of which library, by number
    if (last.first != number_) last = {number_, found()};
    return last.second;
  }

 private:
  static std::uint64_t next_number() {
    static std::atomic<std::uint64_t> number = 0;
    return ++number;
  }
  void* found() const {
    const std::lock_guard lock(mutex_);
    void*& data = opened_[std::this_thread::get_id()];
    if (data == nullptr) data = of_.open();
    if (data == nullptr) refuse("{}: nysalt_open must return a pointer, got null", of_.file);
    return data;
  }

  const c_functions& of_;
  std::uint64_t number_;
  mutable std::mutex mutex_;
  mutable std::map<std::thread::id, void*> opened_;
};

/// A library in use; copies share it.
struct c_library {
  explicit c_library(c_functions all) : functions(std::move(all)), data(functions) {}

  c_functions functions;
  data_of_threads data;
};

class c_hamiltonian {
 public:
  static constexpr int dimension = Eigen::Dynamic;
  static constexpr int lanes = 1;

  explicit c_hamiltonian(std::shared_ptr<const c_library> library) : library_(std::move(library)) {}

  Eigen::Index size() const { return functions().dimension; }
  double potential(const column& q) const {
    return functions().potential(functions().dimension, q.data(), library_->data.get());
  }
  void force(const column& q, column& f) const {
    functions().force(functions().dimension, q.data(), f.data(), library_->data.get());
  }
  double inverse_mass(Eigen::Index i) const {
    return functions().inverse_masses[static_cast<std::size_t>(i)];
  }
  std::string description() const { return functions().description; }
  std::string kind() const { return functions().kind; }

  phase_point<double, Eigen::Dynamic> start(const column& normals) const {
    phase_point<double, Eigen::Dynamic> x{column(size()), column(size())};
    functions().start(functions().dimension, normals.data(), x.q.data(), x.p.data(), library_->data.get());
    return x;
  }

 private:
  const c_functions& functions() const { return library_->functions; }

  std::shared_ptr<const c_library> library_;
};
static_assert(BlackBoxForce<c_hamiltonian> && NystromSystem<c_hamiltonian> && HasEnergy<c_hamiltonian>);

class c_starts {
 public:
  c_starts(c_hamiltonian system, double spread) : system_(std::move(system)), spread_(spread) {}

  phase_point<double, Eigen::Dynamic> operator()(std::uint64_t seed, std::uint64_t n) const {
    column normals(2 * system_.size());
    standard_normals(seed, {.trajectory = n, .purpose = noise_purpose::initial_state}, normals);
    normals *= spread_;
    return system_.start(normals);
  }
  std::string description() const { return sentence("nysalt_start of spread {}", spread_); }

 private:
  c_hamiltonian system_;
  double spread_;
};

template <class F>
F* optional_function(void* library, const char* name) {
  return reinterpret_cast<F*>(dlsym(library, name));
}
template <class F>
F* required_function(void* library, const char* name, const std::string& shown) {
  auto* const found = optional_function<F>(library, name);
  if (found == nullptr) {
    refuse("{}: the library must define {}; see nysalt/c_force.h for its functions", shown, name);
  }
  return found;
}

/// Files of other content are other systems.
std::string fingerprint_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  nysalt::detail::fingerprint all;
  for (std::istreambuf_iterator<char> at(file), end; at != end; ++at) all.add(static_cast<double>(*at));
  return all.text();
}

/// What a function that gives a text returns.
std::string text_returned_by(const char* (*function)(), const char* name, const std::string& shown) {
  const char* const text = function();
  if (text == nullptr) refuse("{}: {} must return a text, got null", shown, name);
  return text;
}

c_functions functions_of(void* library, const std::string& path, const std::string& shown) {
  c_functions all;
  all.file = shown;
  all.force = required_function<decltype(nysalt_force)>(library, "nysalt_force", shown);
  all.potential = required_function<decltype(nysalt_potential)>(library, "nysalt_potential", shown);
  all.start = required_function<decltype(nysalt_start)>(library, "nysalt_start", shown);
  all.open = optional_function<decltype(nysalt_open)>(library, "nysalt_open");
  all.close = optional_function<decltype(nysalt_close)>(library, "nysalt_close");
  all.dimension = required_function<decltype(nysalt_dimension)>(library, "nysalt_dimension", shown)();
  constexpr std::int64_t most = 100'000'000;  // numbers: ten such arrays take eight gigabytes
  if (all.dimension < 1 || all.dimension > most) {
    refuse("{}: nysalt_dimension must be 1 to {}, got {}", shown, most, all.dimension);
  }
  all.inverse_masses.assign(static_cast<std::size_t>(all.dimension), 1.0);
  if (auto* const mass = optional_function<decltype(nysalt_inverse_mass)>(library, "nysalt_inverse_mass")) {
    for (std::int64_t i = 0; i < all.dimension; ++i) {
      const double found = mass(i);
      if (!(found > 0.0) || !std::isfinite(found)) {
        refuse("{}: nysalt_inverse_mass({}) must be positive and finite, got {}", shown, i, found);
      }
      all.inverse_masses[static_cast<std::size_t>(i)] = found;
    }
  }
  auto* const described = optional_function<decltype(nysalt_description)>(library, "nysalt_description");
  all.description = described != nullptr ? text_returned_by(described, "nysalt_description", shown)
                                         : std::filesystem::path(path).stem().string();
  auto* const kind = optional_function<decltype(nysalt_kind)>(library, "nysalt_kind");
  all.kind = kind != nullptr ? text_returned_by(kind, "nysalt_kind", shown) : all.description;
  return all;
}

}  // namespace

bool has_c_force(void* library) { return dlsym(library, "nysalt_force") != nullptr; }

system_declaration declaration_of_c_force(void* library, const std::string& path, const std::string& shown) {
  const auto functions = functions_of(library, path, shown);
  double frequency = 0.0;
  if (auto* const found = optional_function<decltype(nysalt_frequency)>(library, "nysalt_frequency")) {
    frequency = found();
    if (!(frequency > 0.0) || !std::isfinite(frequency)) {
      refuse("{}: nysalt_frequency must be positive and finite, got {}", shown, frequency);
    }
  }
  system_declaration declared;
  declared.name = std::filesystem::path(path).stem().string();
  declared.title = "functions of C, by nysalt/c_force.h";
  declared.described = functions.description;
  declared.identity = fingerprint_of(path);
  declared.make = [functions, frequency](const parameter_values&, const bath& in, double spread) {
    const c_hamiltonian system(std::make_shared<const c_library>(functions));
    return nysalt::detail::made_of(system, in, c_starts(system, spread), frequency);
  };
  return declared;
}

}  // namespace nysalt::program
