#pragma once

/// What a test does to the devices behind the fake libHD.so. A name that is empty is that of the
/// default device. Any thread.
///
/// It behaves as public sources say. The vendor's headers and reference of OpenHaptics 3.0 (as
/// stored in danepowell/openhaptics): numbers, errors, the stack of errors, frames; forces belong
/// into frames (HD_FRAME_ERROR), calibration outside of them and asked for now and then; a check or
/// update of it that fails is HD_DEVICE_FAULT, of a device that goes on; encoders are reset in the
/// reset pose only, before the scheduler. The vendor's samples ErrorHandling.c (forces, impulses
/// and speeds that are too much are warnings, from which the driver comes back by itself) and
/// Calibration.c (HD_CALIBRATION_AUTO goes on refining, and positions jump by it). chai3d and HAPI:
/// force and torque in one frame, torque in mN m. The notes of
/// jhu-cisst-external/3ds-touch-openhaptics: with drivers of 2022 only the default device starts
/// (by which error is not told there).
///
/// A program that is run beside a test is told by its environment: FAKE_HD_DEVICES=NAME,NAME more
/// devices; FAKE_HD_REFUSE=CODE no device starts; FAKE_HD_MOTION=FILE rows `tick x y z buttons`
/// [ms, mm], repeated for ever; FAKE_HD_EVENT=unplug|hang|tell|CODE after FAKE_HD_EVENT_AFTER=N
/// frames with a force, of several by commas the next after N more; FAKE_HD_TORQUE=N six actuated
/// axes, torque up to N mN m; FAKE_HD_LOG=FILE a row `tick failed x y z fx fy fz tx ty tz ns` a
/// frame, and the misuses.
extern "C" {
void fakehd_reset();                ///< as if just loaded
void fakehd_add(const char* name);  ///< a device that is set up
void fakehd_refuse(unsigned code);  ///< no device starts; 0: they do
void fakehd_refuse_names();         ///< only the default device starts
void fakehd_refuse_rates();         ///< no rate can be chosen
void fakehd_drive_by_hand();        ///< ticks come from fakehd_tick() only
void fakehd_tick(int count);        ///< ticks on this thread
void fakehd_hang();                 ///< the scheduler calls nobody any more
unsigned long fakehd_ticks();       ///< so far
unsigned long fakehd_rate();        ///< of the scheduler [Hz]
unsigned long fakehd_misuses();     ///< what the program did wrong
const char* fakehd_first_misuse();

void fakehd_place(const char* name, double x, double y, double z);        ///< [mm]
void fakehd_transform(const char* name, const double* column_by_column);  ///< 16 numbers
void fakehd_press(const char* name, int buttons);
void fakehd_rate_force(const char* name, double peak, double continuous);  ///< what it bears [N]
void fakehd_six_axes(const char* name, double peak, double continuous);    ///< torque [mN m]
void fakehd_temperature(const char* name, double warmth);
void fakehd_no_temperature(const char* name);                 ///< it cannot say
void fakehd_heating(const char* name, double time_constant);  ///< by force squared [ticks]
void fakehd_calibration(const char* name, unsigned state, int styles);
void fakehd_calibration_fails(const char* name, int fails);
void fakehd_calibration_moves(const char* name, double x);    ///< an update does, the tip [mm]
unsigned long fakehd_calibration_checks(const char* name);    ///< so far
unsigned fakehd_updated_style(const char* name);              ///< 0: was not calibrated
void fakehd_raise_at_begin(const char* name, unsigned code);  ///< of its next frame
void fakehd_raise_at_end(const char* name, unsigned code);
void fakehd_unplug(const char* name);
void fakehd_force_off(const char* name, int off);  ///< by itself
int fakehd_is_open(const char* name);
int fakehd_is_on(const char* name, unsigned capability);
unsigned long fakehd_frames(const char* name);
void fakehd_force(const char* name, double* newton);              ///< of the last frame, 3 numbers
void fakehd_torque(const char* name, double* millinewton_metre);  ///< the same
}
