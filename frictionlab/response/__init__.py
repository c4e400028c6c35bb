"""What a contact answers to small and to harmonic slip: impedance, describing function."""
