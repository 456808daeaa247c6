#pragma once
/// The smoke: incompressible flow on a MAC grid with moving hands in it (the paper's section IV-A,
/// and ref. [4]).

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "prostm/core/geometry.hpp"
#include "prostm/core/settings.hpp"
#include "prostm/core/worker_pool.hpp"
#include "prostm/hand/hand_raster.hpp"

namespace prostm {

/// A round jet in the floor of the box: inflow of smoke with a smooth radial profile.
struct SmokeJet {
  Vec2 centre;          ///< in D [m]
  double radius = 0.0;  ///< radius of the profile [m]
  double speed = 0.0;   ///< speed on the axis [m/s]
};

/// Inflow through the floor, and how it mixes with the air in the box.
struct SmokeInflow {
  std::vector<SmokeJet> jets;
  /// speed of clean air let in through the whole floor, so that jets side by side need not draw
  /// each other in [m/s]
  double vent_speed = 0.0;
  /// eddy viscosity ν, the same everywhere [m²/s]; 0: none (F13). Far above that of air, 1.5e-5: it
  /// stands for the small eddies of a turbulent jet, and keeps thin jets steady.
  double viscosity = 0.0;
  /// up to this height above the floor each jet flows as in a tube, whatever moves the air around
  /// it [m]; 0: not guided (F14). If a hand is lower, the tube ends 50 mm below it.
  double guide_height = 0.0;
  double guide_time = 0.1;  ///< time constant with which the tube holds a jet [s]
};

/// Pressure solver: warm-started V-cycles, the paper's sweeps, or for accuracy conjugate gradients
/// that are preconditioned by V-cycles, warm-started too.
enum class PressureMethod : std::uint8_t { Multigrid, Jacobi, Mgpcg };
template <>
inline constexpr std::array<std::string_view, 3> kNames<PressureMethod> = {"multigrid", "jacobi",
                                                                           "mgpcg"};

/// Hands in the grid: by the open fraction of each face (F4), or as whole cells whose centre is in
/// a hand, as in ref. [4].
enum class HandFaces : std::uint8_t { Fractions, Voxels };
template <>
inline constexpr std::array<std::string_view, 2> kNames<HandFaces> = {"fractions", "voxels"};

struct FluidSettings {
  static constexpr int kLeastCells = 32, kMostCells = 160;
  int cells = 64;       ///< cells along each edge of the box, kLeastCells to kMostCells
  double width = 0.36;  ///< edge of the box [m]; it stands on the array's plane, centred, until
                        ///< move_box()
  /// fluid steps per world step, each with its own pressure solve; all but the last use the hands
  /// of the previous world step. Air passes a finger in less than a step of 20 ms.
  int substeps = 1;
  /// weight of the pressure at the end of a particle's path, (F17); the rest acts at its start.
  /// 1: implicit, with an error of the first order in the step
  double theta = 0.6;
  PressureMethod solver = PressureMethod::Multigrid;
  int cycles = 2;            ///< V-cycles a step
  int cg_iterations = 3;     ///< iterations a step of Mgpcg, a V-cycle each
  int jacobi_sweeps = 40;    ///< sweeps a step of the paper's solver
  bool jacobi_warm = false;  ///< start from the last pressure
  /// factor on the speed of the scene's flow, 0 to 3: jets, vent, viscosity and guide alike, so
  /// that the flow stays similar and its pressure goes with the square
  double jet_speed = 1.0;
  HandFaces hand = HandFaces::Fractions;
  double buoyancy = 0.0;     ///< upward acceleration of undiluted smoke [m/s²]
  double vorticity = 0.0;    ///< ε of vorticity confinement [1/s]; 0 = off
  double density = 1.2;      ///< density ρ of the air [kg/m³]
  double dissipation = 0.0;  ///< decay rate of the smoke's density [1/s]

  void visit(SettingsReader& v) const;
  void visit(SettingsWriter& v);
  bool operator==(const FluidSettings&) const = default;
};

struct FluidStats {
  /// rms divergence left over rms divergence before projection
  double divergence_rms = 0;
  /// largest |∇·u| left times dt (dimensionless, cells per step per cell)
  double divergence_max = 0;
  /// estimated rms error of the pressure beside hands, from a solve that is not finished, over the
  /// rms pressure there (F16); 0 without hands
  double pressure_error = 0;
  double max_speed = 0;  ///< [cells per sub-step]
  int solid_cells = 0;
  /// a value was not finite, or absurd (above 10⁶ m/s): the state was set to rest
  bool reset = false;
  double advect = 0, hand = 0, solve = 0, total = 0;  ///< [s]
};

/// One box of smoke. Deterministic: the result depends neither on the number of threads nor on the
/// machine's load.
class Fluid {
 public:
  /// @throws std::invalid_argument with a sentence that names the setting, its value and its bound.
  Fluid(const FluidSettings& settings, const SmokeInflow& inflow, WorkerPool& pool);
  ~Fluid();

  const GridShape& grid() const;
  const FluidSettings& settings() const;

  /// Replaces the inflow from the next step on. Allocates nothing unless there are more jets than
  /// ever before. @pre between steps; within the bounds that the constructor checks.
  void set_inflow(const SmokeInflow& inflow);

  /// Moves the box by whole cells and carries the flow over: new cells get the values of the
  /// nearest old cell. A box that moves by half of its edge or more restarts at rest. pressure()
  /// and fluid_cells() refer to the old place until meet(). Allocates nothing.
  /// @pre between prepare() and meet(), when the last pressure has acted and the previous step's
  /// hands are removed; or before the first step.
  void move_box(const CellShift& by) noexcept;

  /// Advances by dt [s] with the hands of `raster` (made for grid()): docs/design/fluid.md.
  /// Allocates nothing, throws nothing. A dt that is not a positive number, or a raster that is not
  /// finite, resets like a non-finite state.
  FluidStats step(double dt, const HandRaster& raster) noexcept;

  /// The same step in three parts, so that the hands are needed late and their pressure is
  /// available early. step() calls the three in turn, so results agree to the bit. prepare() does
  /// the work that needs no hands (advection and forces); meet() places the hands and solves for
  /// the pressure, after which pressure(), fluid_cells() and smoke_row() are those of this step;
  /// settle() projects the velocity and computes the statistics. @pre called in this order.
  void prepare(double dt) noexcept;
  void meet(const HandRaster& raster) noexcept;
  FluidStats settle() noexcept;

  /// Fluid pressure at cell centres [Pa], 0 in cells without fluid; cell_count() values, index as
  /// in GridShape. With sub-steps or theta < 1 it is the mean pressure over the step: the result of
  /// the last solve alone oscillates about it from step to step.
  std::span<const float> pressure() const;
  /// 1 for cells whose centre is in the fluid (not inside a hand).
  std::span<const std::uint8_t> fluid_cells() const;
  /// Smoke density 0..1 at the centres of a row of cells along x, not copied: valid until the next
  /// prepare().
  std::span<const float> smoke_row(int j, int k) const;
  /// Velocity at a cell centre [m/s].
  Vec3 velocity(int i, int j, int k) const;
  /// Divergence of the velocity in a cell that no hand cuts [1/s].
  double divergence(int i, int j, int k) const;

  /// Copies velocity, smoke and pressure of another fluid, to compare solvers from the same state.
  /// @pre both are between steps.
  /// @throws std::invalid_argument if the grids differ.
  void copy_state(const Fluid& other);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace prostm
