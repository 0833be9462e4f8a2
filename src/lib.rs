//! FARSA.
#![no_std]
