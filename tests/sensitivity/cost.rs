//! Derivatives by a hundred parameters take one evaluation of the contacts and one factorisation, not one a parameter.
