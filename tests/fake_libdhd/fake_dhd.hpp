#pragma once

/// A stand-in for Force Dimension's libdrd.so: two devices, each at a place in the driver's own
/// axes. What a test does to them: any thread. They behave as public sources say: dhdc.h 3.17 as in
/// chai3d (calls, status, results), forcedimension_core's documentation (watchdog, initialisation,
/// time guard, gripper), devices' user lore in ICube's and JHU's ROS drivers (serial numbers).
extern "C" {
void fakedhd_reset();
void fakedhd_place(int index, double x, double y, double z);  ///< [m]
void fakedhd_turn(int index, const double* row_by_row);       ///< 9 numbers
void fakedhd_press(int index, unsigned buttons);
void fakedhd_unplug(int index, int unplugged);       ///< every call fails
void fakedhd_refuse_forces(int index, int refused);  ///< those calls fail, what was set stays
void fakedhd_activate_wrist(int index);
void fakedhd_model(int index, const char* name, int type);
void fakedhd_give_gripper(int index);
void fakedhd_close_gripper(int index, int closed);  ///< a button once it is emulated
void fakedhd_initialised(int index, int is);
void fakedhd_force_off(int index, int cause);          ///< by itself: DHD_FORCEOFF_*
void fakedhd_repeat(int index, int readings);          ///< so many are those of a moment ago
void fakedhd_force(int index, double* newton);         ///< 3 numbers, that act
void fakedhd_torque(int index, double* newton_metre);  ///< 3 numbers
int fakedhd_force_is_on(int index);
int fakedhd_is_open(int index);
int fakedhd_forces(int index);        ///< calls that set one, so far
int fakedhd_turned_on(int index);     ///< how often its force was, so far
int fakedhd_compensates(int index);   ///< its own weight
double fakedhd_max_force(int index);  ///< [N]; 0: not set
}
