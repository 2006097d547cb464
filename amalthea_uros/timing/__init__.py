"""What a system means in time: who runs where with which rank, demand, activations, data flow. No method of analysis is here."""
