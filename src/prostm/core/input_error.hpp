#pragma once
/// Bad input from outside: a file, an option, a value.

#include <stdexcept>

namespace prostm {

/// what() says in one sentence what was wrong, where, and what would be right. The command line
/// prints it and exits 2.
class InputError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace prostm
