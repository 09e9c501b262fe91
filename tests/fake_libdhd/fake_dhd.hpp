#pragma once

/// A stand-in for Force Dimension's libdhd.so: two devices, each at a place in the driver's own
/// axes. What a test does to them: any thread.
extern "C" {
void fakedhd_reset();
void fakedhd_place(int index, double x, double y, double z);  ///< [m]
void fakedhd_turn(int index, const double* row_by_row);       ///< 9 numbers
void fakedhd_press(int index, unsigned buttons);
void fakedhd_unplug(int index, int unplugged);  ///< every call fails
void fakedhd_activate_wrist(int index);
void fakedhd_force(int index, double* newton);         ///< 3 numbers
void fakedhd_torque(int index, double* newton_metre);  ///< 3 numbers
int fakedhd_force_is_on(int index);
int fakedhd_is_open(int index);
}
