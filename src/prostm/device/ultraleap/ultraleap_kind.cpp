#include "prostm/device/ultraleap/ultraleap_kind.hpp"

#include "prostm/device/ultraleap/ultraleap.hpp"

namespace prostm {

#if !defined(PROSTM_ULTRALEAP)

DeviceFinding look_for_ultraleap(const DeviceSetup& /*setup*/) {
  return {false,
          "This build cannot search for Ultraleap arrays: install the vendor's Haptics SDK 3, and "
          "configure prostm with -DPROSTM_ULTRALEAP_ROOT=FOLDER."};
}

#endif

DeviceKind ultraleap_kind() {
  DeviceKind kind{.name = "ultraleap",
                  .address = "[DEVICE][@CONNECTION]",
                  .array = "usx",
                  .tried =
                      "this build lacks the vendor's Haptics SDK 3: install that and configure "
                      "prostm with -DPROSTM_ULTRALEAP_ROOT=FOLDER (docs/devices/ultraleap.md); "
                      "never tried on real hardware",
                  .info = nullptr,
                  .make = nullptr,
                  .look = look_for_ultraleap};
#if defined(PROSTM_ULTRALEAP)
  kind.tried =
      "this build has the vendor's SDK; tried with a stand-in of its interface, never on real "
      "hardware";
  kind.info = ultraleap_info;
  kind.make = make_ultraleap;
#endif
  return kind;
}

}  // namespace prostm
