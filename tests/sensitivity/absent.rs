//! Parameters that a law does not have are refused by name; derivatives that do not exist are NaN with their reason.
