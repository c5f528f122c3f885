// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "server/physics/fluid/floating_shape.hpp"
#include "server/physics/fluid/media.hpp"
#include "server/physics/mechanism/mechanism.hpp"

namespace cohort::physics {

/// The places of a model on which air and water act. Immutable; shared by all bodies of the model.
struct FluidModel {
  FluidModel(const Mechanism& mechanism, const Media& media);
  bool is_empty() const {
    return floats.empty() && rotors.empty() && fins.empty() && drags.empty() && windages.empty();
  }

  /// A frame P on a link.
  struct Place {
    std::size_t link = 0;
    int segment = 0;
    Pose X_SP;
    bool feels_wind = false;
  };
  struct Float : Place {  // P is the frame of the collision
    FloatingShape shape;
  };
  struct RotorPlace : Place {
    const description::Thruster* thruster = nullptr;
  };
  struct FinPlace : Place {
    const description::Fin* fin = nullptr;
    double no_lift = 0.0;  // ratio of upward to forward velocity at zero lift
  };
  struct DragPlace : Place {
    const description::Drag* drag = nullptr;
  };
  struct Windage : Place {  // P is at the centre of mass
    double mass = 0.0;      // [kg]
  };

  std::vector<Float> floats;       // none without water
  std::vector<RotorPlace> rotors;  // in the order of the devices
  std::vector<FinPlace> fins;
  std::vector<DragPlace> drags;
  std::vector<Windage> windages;  // none without wind
};

}  // namespace cohort::physics
