//! Whether a person can read the window, told by machine: no words over each other, nothing cut but what can be scrolled to.

mod faults;
mod pages;
mod painted;
mod poses;
