#pragma once
/// Invalid input: a file, an option, a value.

#include <stdexcept>

namespace prostm {

/// what() is one sentence with the problem, its place and the remedy. The command line prints it
/// and exits with status 2.
class InputError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace prostm
