#pragma once
/// Tables of judgements.

#include <string>
#include <vector>

#include "felt/judge.hpp"
#include "report.hpp"

namespace prostm::bench {

/// All judgements on one set of fields. Ways are compared with the first of them.
struct JudgedSet {
  std::string name;
  std::vector<std::string> fields, ways, skins, disturbances;
  Results results;
};

/// Mean over fields, and how it compares with the first way's.
struct Compared {
  double mean = 0.0;   ///< S_8.5
  double more = 0.0;   ///< mean of the paired differences
  double error = 0.0;  ///< its standard error; 0 for a single field
  double lack = 1.0;   ///< mean of 1 − S over that of the first way
  double worst = 1.0;  ///< largest ratio of 1 − S on one field
  std::size_t worst_field = 0;
  int worse = 0;  ///< fields with a lower S than the first way's
};
/// @param own, first S_8.5 of the way and of the first way on each field. @pre not empty, sizes
/// agree.
Compared compare(const std::vector<double>& own, const std::vector<double>& first);
/// Compares the felt shape of a way with that of the first. @param way < the number of ways.
Compared compare_shape(const JudgedSet& set, std::size_t way);

/// Strength, the largest √e, compared with that of the first way.
struct Strength {
  double mean = 0.0;      ///< over the fields [m]
  double ratio = 1.0;     ///< of the means
  double least = 1.0;     ///< ratio on a field
  int worse_in_both = 0;  ///< fields that are weaker and have a lower S_8.5
};
/// @param way < the number of ways.
Strength compare_strength(const JudgedSet& set, std::size_t way);

/// Returns the fields of several sets as one set. @pre they have the same ways, skins and
/// disturbances.
JudgedSet pooled(const std::string& name, const std::vector<JudgedSet>& sets);

/// Prints four tables: what is felt, other readouts, other skins, disturbances.
void print_tables(const JudgedSet& set);
/// Prints S_8.5 of what is felt and √E of every way on every field.
void print_each(const JudgedSet& set);
/// Adds the distributions of lack, felt and of the envelope, and of √E for every way.
void add_rows(const JudgedSet& set, std::vector<Row>& rows);

}  // namespace prostm::bench
