#include "device_bridge/workspace.hpp"
#include "tests/support/catch.hpp"

using namespace irdm;

namespace {

const Workspace kSomewhere{.position = Vector3(0.1, -0.2, 0.3),
                           .rotation = Quaternion(0.5, -0.1, 0.7, 0.3).normalized(),
                           .scale = 2.5,
                           .force_scale = 0.4};

}  // namespace

TEST_CASE("a workspace left out changes nothing, to the bit") {
  const Workspace identity;
  const StylusPose pose{.tip = Vector3(0.1, 0.2, -0.3), .buttons = 5};
  CHECK(identity.to_world(pose).tip == pose.tip);
  CHECK(identity.to_world(pose).orientation.coeffs() == pose.orientation.coeffs());
  CHECK(identity.to_world(pose).buttons == 5);
  CHECK(identity.to_device(Vector3(1, 2, 3)) == Vector3(1, 2, 3));
}

TEST_CASE("a workspace places a point by hand calculation") {
  // A quarter turn about y takes z to x and x to -z.
  const Workspace workspace{.position = Vector3(1, 2, 3),
                            .rotation = Quaternion(Eigen::AngleAxisd(M_PI / 2, Vector3::UnitY())),
                            .scale = 2.0,
                            .force_scale = 3.0};
  CHECK(workspace.to_world(Vector3(0.1, 0.2, 0.3)).isApprox(Vector3(1.6, 2.4, 2.8)));
  CHECK(workspace.to_device(Vector3(1, 0, 0)).isApprox(Vector3(0, 0, 3)));
  const StylusPose pose{.orientation = Quaternion(Eigen::AngleAxisd(0.3, Vector3::UnitX()))};
  CHECK(workspace.to_world(pose).orientation.isApprox(workspace.rotation * pose.orientation));
}

TEST_CASE("a point comes back through the inverse of its workspace") {
  const Vector3 point(0.03, 0.05, -0.07);
  const Quaternion back = kSomewhere.rotation.conjugate();
  const Workspace inverse{.position = -(back * kSomewhere.position) / kSomewhere.scale,
                          .rotation = back,
                          .scale = 1.0 / kSomewhere.scale,
                          .force_scale = 1.0 / kSomewhere.force_scale};
  CHECK(inverse.to_world(kSomewhere.to_world(point)).isApprox(point, 1e-14));
  CHECK(inverse.to_device(kSomewhere.to_device(point)).isApprox(point, 1e-14));
}

TEST_CASE("power at the device is power in W times force_scale over scale") {
  const Vector3 velocity_D(0.3, -0.1, 0.2);
  const Vector3 force_W(1.0, 2.0, -0.5);
  // Exactly linear, so that a difference of positions is a velocity.
  const Vector3 velocity_W =
      kSomewhere.to_world(velocity_D) - kSomewhere.to_world(Vector3(0, 0, 0));
  const double ratio = kSomewhere.force_scale / kSomewhere.scale;
  CHECK(kSomewhere.to_device(force_W).dot(velocity_D) ==
        Approx(ratio * force_W.dot(velocity_W)).epsilon(1e-13));
  // What turns in D turns in W as fast, about the axis as it lies there.
  const Vector3 torque_W(0.02, -0.01, 0.05);
  CHECK(kSomewhere.torque_to_device(torque_W).dot(velocity_D) ==
        Approx(ratio * torque_W.dot(kSomewhere.rotation * velocity_D)).epsilon(1e-13));
}
