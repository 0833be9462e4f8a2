//! A line to the host by semihosting, without `core::fmt`, which can panic and is larger than the controller.

use semihosting::sys::arm_compat::{ExitReason, sys_exit, sys_writec};

/// Writes a name and a number in decimal.
pub fn say(name: &str, number: u32) {
    write(name);
    let mut divisor = 1_000_000_000;
    while divisor > 1 && number < divisor {
        divisor /= 10;
    }
    while divisor > 0 {
        sys_writec(b'0' + (number / divisor % 10) as u8);
        divisor /= 10;
    }
    sys_writec(b'\n');
}

/// Writes a name and a number in 16 hexadecimal digits.
pub fn say_hex(name: &str, number: u64) {
    write(name);
    for digit in (0..16).rev() {
        let value = (number >> (4 * digit)) as u8 & 15;
        sys_writec(if value < 10 { b'0' + value } else { b'a' + value - 10 });
    }
    sys_writec(b'\n');
}

fn write(name: &str) {
    name.bytes().for_each(sys_writec);
    sys_writec(b' ');
}

/// Ends the emulator with success or failure.
pub fn exit(success: bool) -> ! {
    sys_exit(if success {
        ExitReason::ADP_Stopped_ApplicationExit
    } else {
        ExitReason::ADP_Stopped_RunTimeErrorUnknown
    });
    loop {}
}
